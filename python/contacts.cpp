#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "pillarfield/contact_columns.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/version.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/process.h"

namespace pillarfield::python {
namespace {

constexpr const char* kContact =
    "A contact of a frame: force on the skin, place, friction and slip, with an id that stays.";
constexpr const char* kTotal = "The total over all loaded pillars of a frame.";
constexpr const char* kFrameContacts =
    R"(The contacts of a frame, a sequence of Contact by label.)";
constexpr const char* kTracker = R"(Finds the contacts of frame after frame and tracks them.

plan: Plan of the solver; it gives pitch, friction and noise of the sensor
minimum_pillars: smaller contacts are neither listed nor tracked
reach_mm: how far a contact may move between frames, 0..1000

Raises Error for a value out of range.)";

/// A quantity as an int, a float or a str; None where it is unset or does not exist.
py::object value_of(const QuantityColumn& column, const ContactQuantities& quantities) {
  if (column.of_pillars && !quantities.has_shear) return py::none();
  const double value = column.get(quantities);
  if (column.kind == ColumnKind::word) return py::str(column.word(value));
  if (column.kind != ColumnKind::number) return py::int_(static_cast<std::uint64_t>(value));
  if (std::isnan(value)) return py::none();
  return py::float_(value);
}

std::string help_of(const QuantityColumn& column) {
  return fmt::format("{}{}{}{}", column.help, *column.unit != '\0' ? ", " : "", column.unit,
                     column.of_pillars || column.optional ? ", or None" : "");
}

/// Adds the quantities of a contact to a class, and a pair "NAME_mm" for each "NAME_x_mm" and
/// "NAME_y_mm"; `get` returns them for an object of it.
template <class Class, class Get>
void add_quantities(Class& bound, Get get) {
  using Self = typename Class::type;
  const QuantityColumns columns = quantity_columns();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const QuantityColumn& column = columns[i];
    bound.def_property_readonly(
        column.name, [get, &column](const Self& self) { return value_of(column, get(self)); },
        help_of(column).c_str());
    constexpr std::string_view kX = "_x_mm";
    const std::string_view name = column.name;
    if (!name.ends_with(kX)) continue;
    bound.def_property_readonly(
        (std::string(name.substr(0, name.size() - kX.size())) + "_mm").c_str(),
        [get, pair = columns.subspan(i, 2)](const Self& self) {
          return py::make_tuple(value_of(pair[0], get(self)), value_of(pair[1], get(self)));
        },
        fmt::format("{}: (x, y), mm", column.help).c_str());
  }
  bound.def_property_readonly(
      "wrench",
      [get](const Self& self) -> py::object {
        const auto& wrench = get(self).wrench;
        if (!wrench) return py::none();
        const auto& [force, moment] = *wrench;
        return py::make_tuple(py::make_tuple(force.x, force.y, force.z),
                              py::make_tuple(moment.x, moment.y, moment.z));
      },
      "((force x, y, z in N), (moment x, y, z in N mm)) in the body's frame, or None");
}

std::string contact_text(const TrackedContact& contact) {
  const ContactQuantities& q = contact.quantities;
  if (!q.has_shear) {
    return fmt::format("<Contact {}: {}, {:.3g} N, at most {:.3g} kPa>", contact.track_id,
                       counted(q.pillars, "sensel"), q.normal_n, q.peak_pressure_kpa());
  }
  return fmt::format("<Contact {}: {}, shear ({:.3g}, {:.3g}) N, normal {:.3g} N, {}>",
                     contact.track_id, counted(q.pillars, "pillar"), q.shear_x_n, q.shear_y_n,
                     q.normal_n, name_of(q.slip));
}

std::string total_text(const ContactQuantities& q) {
  return fmt::format(
      "<ContactTotal: {} {}, normal {:.3g} N{}>", q.pillars, q.has_shear ? "pillars" : "sensels",
      q.normal_n,
      q.has_shear ? fmt::format(", shear ({:.3g}, {:.3g}) N", q.shear_x_n, q.shear_y_n) : "");
}

using SharedContacts = std::shared_ptr<FrameContacts>;

TrackedContact contact_at(const FrameContacts& self, py::ssize_t index) {
  const auto size = static_cast<py::ssize_t>(self.contacts.size());
  if (index < -size || index >= size) throw py::index_error("contact index out of range");
  return self.contacts[static_cast<std::size_t>(index < 0 ? index + size : index)];
}

py::list ended_of(const FrameContacts& self) {
  py::list ended;
  for (const EndedContact& contact : self.ended) {
    ended.append(py::make_tuple(contact.track_id, contact.merged_into));
  }
  return ended;
}

/// Calls visit(columns, row) for all rows of a frame.
template <class Visit>
void visit_rows(FrameContacts& frame, Visit visit) {
  visit(quantity_columns(true), frame.total);
  for (TrackedContact& contact : frame.contacts) {
    contact.quantities.has_shear = frame.total.has_shear;
    visit(identity_columns(), contact);
    visit(quantity_columns(true), contact.quantities);
  }
  for (EndedContact& contact : frame.ended) visit(ended_columns(), contact);
}

/// Version, time, whether there are pillars, numbers of contacts and of ended ones, all numbers.
py::tuple contacts_state(const FrameContacts& self) {
  std::vector<double> numbers;
  FrameContacts frame = self;
  visit_rows(frame, [&](auto columns, const auto& row) {
    for (const auto& column : columns) numbers.push_back(column.get(row));
  });
  return py::make_tuple(kVersion, self.time_s, self.total.has_shear, self.contacts.size(),
                        self.ended.size(), numbers);
}

SharedContacts contacts_from(const py::tuple& state) {
  check_version(state, "FrameContacts");
  auto frame = std::make_shared<FrameContacts>();
  frame->time_s = state[1].cast<double>();
  frame->total.has_shear = state[2].cast<bool>();
  const auto numbers = state[5].cast<std::vector<double>>();  // Each contact has some.
  frame->contacts.resize(std::min(state[3].cast<std::size_t>(), numbers.size()));
  frame->ended.resize(std::min(state[4].cast<std::size_t>(), numbers.size()));
  visit_rows(*frame, [&, next = std::size_t{0}](auto columns, auto& row) mutable {
    for (const auto& column : columns) column.set(row, numbers.at(next++));
  });
  return frame;
}

/// A column of a table, with a value for each row: integers, numbers or words.
template <class Row>
py::object column_of(const ContactColumn<Row>& column, const std::vector<const Row*>& rows) {
  const auto size = static_cast<py::ssize_t>(rows.size());
  if (column.kind == ColumnKind::word) {
    py::list words;
    for (const Row* row : rows) words.append(column.word(column.get(*row)));
    return py::module_::import("numpy").attr("array")(words, "str");  // Empty ones, too.
  }
  const auto array = [&]<class T>(T) {
    std::vector<T> values;
    for (const Row* row : rows) values.push_back(static_cast<T>(column.get(*row)));
    return array_of(std::move(values), {size});
  };
  if (column.kind == ColumnKind::number) return array(double{});
  return array(std::int64_t{});
}

/// {"id": ..., "normal_n": ..., ...}: a row for each frame, or for each contact of each frame.
py::dict columns_of(const std::vector<SharedContacts>& frames, bool totals) {
  std::vector<const TrackedContact*> contacts;
  std::vector<const ContactQuantities*> quantities;
  for (const SharedContacts& frame : frames) {
    if (totals) {
      quantities.push_back(&frame->total);
      continue;
    }
    for (const TrackedContact& contact : frame->contacts) {
      contacts.push_back(&contact);
      quantities.push_back(&contact.quantities);
    }
  }
  py::dict columns;
  if (!totals) {
    for (const auto& column : identity_columns())
      columns[column.name] = column_of(column, contacts);
  }
  const bool on_surface = !frames.empty() && frames.front()->total.wrench;
  const bool has_pillars = frames.empty() || frames.front()->total.has_shear;
  for (const auto& column :
       quantity_columns(on_surface, has_pillars ? SkinLayout::pillars : SkinLayout::sensels)) {
    columns[column.name] = column_of(column, quantities);
  }
  return columns;
}

/// A ContactTracker with the plan's constants, used by one thread at a time.
class Tracker {
 public:
  Tracker(const SolverPlan& plan, std::uint64_t minimum_pillars, double reach_mm)
      : tracker_(std::make_unique<ContactTracker>(plan.skin.element_pitch_mm(),
                                                  options_of(plan, minimum_pillars, reach_mm))) {}

  /// The contacts of each frame.
  std::vector<SharedContacts> update(const py::dict& planes, const std::vector<double>& times) {
    const ForceArrays forces(planes);
    if (times.size() != forces.frames()) throw Error("Contacts", "the times are not one a frame");
    if (tracker_.is_foreign()) throw_foreign("Contacts");
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(mutex_);
    std::vector<SharedContacts> contacts;
    for (std::size_t i = 0; i < times.size(); ++i) {
      contacts.push_back(
          std::make_shared<FrameContacts>(tracker_.get()->update(forces.frame(i), times[i])));
    }
    return contacts;
  }

 private:
  static ContactOptions options_of(const SolverPlan& plan, std::uint64_t minimum_pillars,
                                   double reach_mm) {
    ContactOptions options;
    set_sensor(options, plan);
    options.minimum_pillars = minimum_pillars;
    options.reach_mm = reach_mm;
    return options;
  }

  std::mutex mutex_;
  ProcessBound<ContactTracker> tracker_;
};

}  // namespace

void bind_contacts(py::module_& module) {
  py::class_<ContactQuantities> total(module, "ContactTotal", kTotal);
  add_quantities(
      total, [](const ContactQuantities& self) -> const auto& { return self; });
  total.def("__repr__", &total_text);
  py::class_<TrackedContact> contact(module, "Contact", kContact);
  add_quantities(
      contact, [](const TrackedContact& self) -> const auto& { return self.quantities; });
  contact.def_readonly("track_id", &TrackedContact::track_id, "1, 2, ...; never reused")
      .def_readonly("id", &TrackedContact::track_id, "track_id, as tables name it")
      .def_readonly("parent", &TrackedContact::parent, "track_id that it split from, or None")
      .def_readonly("first_time_s", &TrackedContact::first_time_s, "time of its first frame, s")
      .def_readonly("age_s", &TrackedContact::age_s, "time since then, s")
      .def("__repr__", &contact_text);
  py::class_<FrameContacts, SharedContacts>(module, "FrameContacts", kFrameContacts)
      .def_readonly("time_s", &FrameContacts::time_s, "time of the frame, s")
      .def_readonly("total", &FrameContacts::total, "ContactTotal over all loaded pillars")
      .def_property_readonly("ended", &ended_of,
                             "[(track_id, track_id that it merged into or None), ...]")
      .def("__len__", [](const FrameContacts& self) { return self.contacts.size(); })
      .def("__getitem__", &contact_at, py::arg("index"))
      .def("__repr__",
           [](const FrameContacts& self) {
             return fmt::format("<FrameContacts: {}, {:.3g} N>",
                                counted(self.contacts.size(), "contact"), self.total.normal_n);
           })
      .def(py::pickle(&contacts_state, &contacts_from));
  module.def("contact_columns", &columns_of, py::arg("frames"), py::arg("totals"),
             "Columns of a table of contacts, or of the totals of frames, by name.");
  py::class_<Tracker>(module, "Tracker", kTracker)
      .def(py::init([](const SolverPlan& plan, std::uint64_t minimum_pillars, double reach_mm,
                       const py::kwargs& unknown) {
             refuse("Contacts", unknown, {"minimum_pillars", "reach_mm"});
             return std::make_unique<Tracker>(plan, minimum_pillars, reach_mm);
           }),
           py::arg("plan"), py::kw_only(),
           py::arg("minimum_pillars") = ContactOptions{}.minimum_pillars,
           py::arg("reach_mm") = ContactOptions{}.reach_mm)
      .def("update_planes", &Tracker::update, py::arg("planes"), py::arg("times"),
           "FrameContacts of each of the next frames, from planes [frames, rows, cols].");
}

}  // namespace pillarfield::python
