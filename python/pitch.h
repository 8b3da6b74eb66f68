#pragma once

#include <pybind11/pybind11.h>

#include <tuple>
#include <utility>

#include "pillarfield/pitch.h"

/// A Pitch is a number in Python, or a tuple: from row to row, from column to column.
template <>
struct pybind11::detail::type_caster<pillarfield::Pitch> {
  PYBIND11_TYPE_CASTER(pillarfield::Pitch, const_name("float | tuple[float, float]"));

  bool load(handle source, bool convert) {
    make_caster<double> one;
    make_caster<std::pair<double, double>> two;
    const bool is_one = one.load(source, convert);
    if (!is_one && !two.load(source, convert)) return false;
    if (is_one) value = cast_op<double>(one);
    if (!is_one) std::tie(value.row_mm, value.col_mm) = cast_op<std::pair<double, double>>(two);
    return true;
  }

  static handle cast(const pillarfield::Pitch& pitch, return_value_policy, handle) {
    if (pitch.is_square()) return pybind11::float_(pitch.col_mm).release();
    return make_tuple(pitch.row_mm, pitch.col_mm).release();
  }
};
