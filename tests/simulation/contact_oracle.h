#pragma once

#include "pillarfield/closed_form_contact.h"

namespace pillarfield::oracle {

/// Traction on the skin at a point, N/mm²; pressure positive.
struct Traction {
  double x = 0;
  double y = 0;
  double pressure = 0;
};

/// A square cell, mm.
struct Cell {
  double x0;
  double x1;
  double y0;
  double y1;
};

/// Force on a cell, N: the textbook's traction, point by point, integrated numerically by the
/// double exponential rule. Shares no code with the library. Within 1e-7 of the contact's load.
Traction force_on_cell(const ClosedFormContact& contact, const ContactKey& state, const Cell& cell);

}  // namespace pillarfield::oracle
