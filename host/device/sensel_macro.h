#pragma once

#include "pillarfield/skin.h"

namespace pillarfield {

/// The OpenCL C type of a reading.
constexpr const char* sensel_macro(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "uchar";
    case SenselType::u16:
      return "ushort";
    case SenselType::f32:
      break;
  }
  return "float";
}

}  // namespace pillarfield
