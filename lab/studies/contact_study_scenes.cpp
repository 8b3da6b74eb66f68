// Closed-form contacts at several frictions and noises.

#include "lab/studies/contact_study_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "lab/studies/contact_study.h"

namespace pillarfield::contact_study {
namespace {

constexpr double kCountsPerNewton = 320;
constexpr std::array kNoises = {0.25, 0.5, 1.0};

/// Common parameters of a set of contacts.
struct Set {
  std::vector<double> frictions;
  std::vector<double> load_ratios;
  double first_direction_deg;
  double direction_step_deg;
  double first_offset;  ///< offset of the first contact from a pillar corner
  std::uint64_t first_seed;
};

std::string drive_name(const TangentialLoad& drive) {
  std::string name = name_of(drive.motion);
  switch (drive.motion) {
    case Motion::partial_slip:
      return fmt::format("{} {:.3g} at {:.4g}°", name, drive.load_ratio, drive.direction_deg);
    case Motion::slide:
      return fmt::format("{} to {:.4g}°", name, drive.direction_deg);
    case Motion::partial_turn:
    case Motion::roll:
      return fmt::format("{} {:.3g}", name, drive.load_ratio);
    default:
      return name;
  }
}

std::string body_name(const Body& body) {
  std::string name = fmt::format("{} {:.3g}", name_of(body.shape), body.radius);
  return body.waves > 0 ? fmt::format("{} x {:.3g}", name, body.waves) : name;
}

/// Key of a contact within a set; contacts of one name may differ in place.
std::string contact_key(const ClosedForm& scene) {
  return fmt::format("{} {}", scene.contact_name, scene.contact.body.x);
}

/// Collects contacts, each with its own offset from the pillars.
class Contacts {
 public:
  explicit Contacts(Set set) : set_(std::move(set)) {}

  void add(const Body& body, double peak_counts, const TangentialLoad& drive) {
    StudyContact contact{body, drive, peak_counts};
    const double number = set_.first_offset + static_cast<double>(contacts_.size());
    contact.body.x = std::fmod(0.6180339887 * number, 1.0) - 0.5;
    contact.body.y = std::fmod(0.7548776662 * number, 1.0) - 0.5;
    contacts_.push_back(contact);
  }

  void press(const Body& body, double peak) { add(body, peak, {}); }

  void slide(const Body& body, double peak, int directions) {
    for (int i = 0; i < directions; ++i) {
      add(body, peak, {.motion = Motion::slide, .direction_deg = next_direction()});
    }
  }

  void partial_slip(const Body& body, double peak) {
    for (const double ratio : set_.load_ratios) {
      add(body, peak,
          {.motion = Motion::partial_slip,
           .direction_deg = next_direction_along_axis(),
           .load_ratio = ratio});
    }
  }

  void spin(const Body& body, double peak) { add(body, peak, {.motion = Motion::spin}); }

  void roll(const Body& body, double peak) {
    for (const double ratio : set_.load_ratios) {
      add(body, peak, {.motion = Motion::roll, .load_ratio = ratio});
    }
  }

  void turn(const Body& body, double peak, double x, double y) {
    add(body, peak, {.motion = Motion::turn, .pivot_x = x, .pivot_y = y});
    add(body, peak,
        {.motion = Motion::partial_turn,
         .load_ratio = set_.load_ratios.back(),
         .pivot_x = x,
         .pivot_y = y});
  }

  /// Adds the motions common to all bodies.
  void usual(const Body& body, double peak) {
    press(body, peak);
    partial_slip(body, peak);
    slide(body, peak, 2);
    spin(body, peak);
  }

  [[nodiscard]] std::vector<ClosedForm> scenes(std::string_view filter) const;

 private:
  double next_direction() {
    const double direction = set_.first_direction_deg + set_.direction_step_deg * slides_++;
    return std::fmod(direction, 360.0);
  }

  /// A direction near a pillar axis, where region 3 occurs.
  double next_direction_along_axis() {
    const int drag = drags_++;
    return std::fmod(set_.first_direction_deg + 90.0 * drag + 1.5 * (drag % 7), 360.0);
  }

  Set set_;
  std::vector<StudyContact> contacts_;
  int slides_ = 0;
  int drags_ = 0;
};

/// The scenes of a contact: all noises and, with shear, all frictions.
void append_scenes(const StudyContact& contact, const std::vector<double>& frictions,
                   std::uint64_t& seed, std::vector<ClosedForm>& scenes) {
  ClosedForm scene;
  scene.contact = contact;
  scene.contact_name = body_name(contact.body) + ", " + drive_name(contact.tangential);
  const bool press = contact.tangential.motion == Motion::press;
  for (std::size_t i = 0; i < (press ? 1 : frictions.size()); ++i) {
    for (const double noise : kNoises) {
      scene.friction = frictions[i];
      scene.noise_counts = noise;
      scene.seed = seed++;
      scenes.push_back(scene);
    }
  }
}

std::vector<ClosedForm> Contacts::scenes(std::string_view filter) const {
  std::vector<ClosedForm> all;
  std::uint64_t seed = set_.first_seed;
  for (const StudyContact& contact : contacts_) append_scenes(contact, set_.frictions, seed, all);
  std::erase_if(
      all, [&](const ClosedForm& scene) { return scene.name().find(filter) == std::string::npos; });
  return all;
}

Body body(Shape shape, double radius) { return {.shape = shape, .radius = radius}; }

Body two(Shape shape, double radius, double second, double aspect, double angle_deg) {
  return {
      .shape = shape, .radius = radius, .second = second, .aspect = aspect, .angle_deg = angle_deg};
}

Body wavy(double radius, double waves, double ripple) {
  return {.shape = Shape::wavy, .radius = radius, .waves = waves, .ripple = ripple};
}

Body long_body(Shape shape, double radius, double aspect, double angle_deg) {
  return {.shape = shape, .radius = radius, .aspect = aspect, .angle_deg = angle_deg};
}

Body flattened(Shape shape, double radius, double flat) {
  return {.shape = shape, .radius = radius, .second = flat};
}

}  // namespace

std::string ClosedForm::name() const {
  return fmt::format("{}, mu {:.3g}, noise {:g}", contact_name, friction, noise_counts);
}

std::vector<ClosedForm> closed_forms(std::string_view filter) {
  Contacts contacts({{1.45, 1.6, 2.0, 2.5}, {0.5, 0.7, 0.9}, 3, 47, 0.71, 500'000});
  const Body sphere = body(Shape::sphere, 30);
  contacts.usual(sphere, 100);
  contacts.slide(sphere, 100, 6);
  contacts.roll(sphere, 100);
  contacts.turn(sphere, 100, -0.3, 0.45);
  for (const auto& [radius, peak] : {std::pair{12.0, 40.0}, {45.0, 200.0}}) {
    contacts.partial_slip(body(Shape::sphere, radius), peak);
    contacts.spin(body(Shape::sphere, radius), peak);
  }
  contacts.usual(body(Shape::paraboloid, 34), 80);
  contacts.usual(two(Shape::two_spheres, 19, 0.6, 0.95, -35), 120);
  contacts.usual(two(Shape::merged_spheres, 20, 0.85, 0.7, 70), 100);
  contacts.usual(wavy(28, 14, 0.1), 100);
  contacts.usual(wavy(32, 6, 0.2), 85);
  const Body ellipse = long_body(Shape::ellipse, 36, 0.55, 12);
  contacts.usual(ellipse, 105);
  contacts.roll(ellipse, 105);
  contacts.turn(ellipse, 105, 0.5, 0.1);
  contacts.usual(body(Shape::cone, 33), 120);
  contacts.usual(flattened(Shape::truncated_cone, 30, 0.3), 100);
  contacts.usual(body(Shape::punch, 31), 110);
  contacts.usual(flattened(Shape::rounded_punch, 28, 0.75), 90);
  const Body cylinder = long_body(Shape::cylinder, 13, 2.2, -6);
  contacts.press(cylinder, 110);
  contacts.partial_slip(cylinder, 110);
  contacts.roll(cylinder, 110);
  std::vector<ClosedForm> scenes = contacts.scenes(filter);
  // Below a friction of 1.41 few pillars are ambiguous: one friction is enough.
  Contacts little({{1.0}, {0.9}, 3, 47, 0.17, 900'000});
  little.partial_slip(sphere, 100);
  little.slide(sphere, 100, 1);
  little.spin(sphere, 100);
  const std::vector<ClosedForm> more = little.scenes(filter);
  scenes.insert(scenes.end(), more.begin(), more.end());
  return scenes;
}

void integrate(std::vector<ClosedForm>& scenes) {
  std::map<std::string, std::shared_ptr<const PillarLoads>> loads;
  std::vector<const ClosedForm*> first_of_contact;
  for (const ClosedForm& scene : scenes) {
    if (loads.try_emplace(contact_key(scene)).second) first_of_contact.push_back(&scene);
  }
  for_each_index(first_of_contact.size(), [&](std::size_t i) {
    const ClosedForm& scene = *first_of_contact[i];
    loads.at(contact_key(scene)) = std::make_shared<PillarLoads>(loads_of(scene.contact));
  });
  for (ClosedForm& scene : scenes) scene.loads = loads.at(contact_key(scene));
}

Recording record(const ClosedForm& scene) {
  Scene sensor;
  sensor.title = scene.name();
  sensor.skin.rows = 2 * scene.loads->rows;
  sensor.skin.cols = 2 * scene.loads->cols;
  sensor.skin.counts_per_newton = kCountsPerNewton;
  sensor.skin.threshold_counts = 4 * scene.noise_counts;
  sensor.sensor.noise_counts = scene.noise_counts;
  sensor.seed = scene.seed;
  Recording recording =
      read_forces(sensor, {truth_of(*scene.loads, scene.friction, kCountsPerNewton)});
  recording.friction = scene.friction;
  return recording;
}

}  // namespace pillarfield::contact_study
