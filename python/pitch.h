#pragma once

#include <pybind11/pybind11.h>

#include "pillarfield/pitch.h"

/// A Pitch is a number in Python, or a tuple: from row to row, from column to column.
template <>
struct pybind11::detail::type_caster<pillarfield::Pitch> {
  PYBIND11_TYPE_CASTER(pillarfield::Pitch, const_name("float | tuple[float, float]"));

  bool load(handle source, bool convert) {
    make_caster<double> one;
    if (one.load(source, convert)) {
      value = cast_op<double>(one);
      return true;
    }
    if (!isinstance<sequence>(source) || len(source) != 2) return false;
    const auto numbers = reinterpret_borrow<sequence>(source);
    make_caster<double> row_mm;
    make_caster<double> col_mm;
    if (!row_mm.load(numbers[0], convert) || !col_mm.load(numbers[1], convert)) return false;
    value = {cast_op<double>(row_mm), cast_op<double>(col_mm)};
    return true;
  }

  static handle cast(const pillarfield::Pitch& pitch, return_value_policy, handle) {
    if (pitch.is_square()) return pybind11::float_(pitch.col_mm).release();
    return make_tuple(pitch.row_mm, pitch.col_mm).release();
  }
};
