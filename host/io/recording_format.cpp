#include "io/recording_format.h"

namespace pillarfield::recording_format {

hid_t stored_type_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return H5T_STD_U8LE;
    case SenselType::u16:
      return H5T_STD_U16LE;
    case SenselType::f32:
      break;
  }
  return H5T_IEEE_F32LE;
}

hid_t memory_type_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return H5T_NATIVE_UINT8;
    case SenselType::u16:
      return H5T_NATIVE_UINT16;
    case SenselType::f32:
      break;
  }
  return H5T_NATIVE_FLOAT;
}

}  // namespace pillarfield::recording_format
