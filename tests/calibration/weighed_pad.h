#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/tare.h"

namespace pillarfield::core_test {

/// A body on a pad: it presses with (1 − ρ²)^roundness over an ellipse, and tilts. Lengths in
/// sensels.
struct Body {
  double weight_n = 10;
  double radius = 3;
  double aspect = 1;
  double angle = 0;
  double roundness = 0.7;
  double tilt_x = 0;  ///< relative rise of the pressure over a radius
  double tilt_y = 0;
  double row = 8;  ///< of its centre; a sensel covers [row, row + 1)
  double col = 16;
};

/// A pad of bare sensels of its own: tare + counts · (sensitivity · force)^power, noise, whole
/// counts. Shares no code with the product's simulator.
class WeighedPad {
 public:
  struct Model {
    std::uint32_t rows = 16;
    std::uint32_t cols = 32;
    double spread = 0.2;
    double power = 0.8;
    double noise = 0.7;
    double counts_at_newton = 600;
    double dead_zone = 0;  ///< counts
  };

  WeighedPad(std::uint64_t seed, const Model& model) : model_(model), random_(seed) {
    const std::size_t sensels = std::size_t{model.rows} * model.cols;
    for (std::size_t i = 0; i < sensels; ++i) {
      sensitivity_.push_back(std::exp(model.spread * normal()));
      tare_.push_back(8 + 8 * uniform());
    }
  }

  [[nodiscard]] Skin skin() const {
    Skin skin;
    skin.rows = model_.rows;
    skin.cols = model_.cols;
    skin.full_scale_counts = 255;
    return skin;
  }

  [[nodiscard]] std::vector<double>& sensitivity() { return sensitivity_; }
  [[nodiscard]] double uniform() { return std::uniform_real_distribution<double>()(random_); }
  [[nodiscard]] double normal() { return std::normal_distribution<double>()(random_); }

  /// Force on each sensel, N. What presses beside the pad is lost.
  [[nodiscard]] std::vector<double> forces(const Body& body) const {
    constexpr int kParts = 4;
    std::vector<double> forces(sensitivity_.size(), 0);
    double all = 0;
    const double reach = body.radius * std::sqrt(body.aspect) + 1;
    const int top = static_cast<int>(std::floor(body.row - reach)) * kParts;
    const int left = static_cast<int>(std::floor(body.col - reach)) * kParts;
    const int span = static_cast<int>(2 * reach + 2) * kParts;
    const double cosine = std::cos(body.angle);
    const double sine = std::sin(body.angle);
    for (int i = top; i < top + span; ++i) {
      for (int j = left; j < left + span; ++j) {
        const double y = (i + 0.5) / kParts - body.row;
        const double x = (j + 0.5) / kParts - body.col;
        const double u = (cosine * x + sine * y) / (body.radius * std::sqrt(body.aspect));
        const double v = (cosine * y - sine * x) / (body.radius / std::sqrt(body.aspect));
        const double rest = 1 - u * u - v * v;
        if (rest <= 0) continue;
        const double tilt = 1 + (body.tilt_x * x + body.tilt_y * y) / body.radius;
        const double pressure = std::pow(rest, body.roundness) * std::max(0.05, tilt);
        all += pressure;
        const int row = i / kParts;
        const int col = j / kParts;
        if (i < 0 || j < 0 || row >= static_cast<int>(model_.rows) ||
            col >= static_cast<int>(model_.cols)) {
          continue;
        }
        forces[static_cast<std::size_t>(row) * model_.cols + static_cast<std::size_t>(col)] +=
            pressure;
      }
    }
    for (double& force : forces) force *= body.weight_n / all;
    return forces;
  }

  [[nodiscard]] FrameBuffer read(const std::vector<double>& forces) {
    FrameBuffer frame(SenselType::u8, model_.rows, model_.cols);
    const auto readings = frame.readings<std::uint8_t>();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const double load = sensitivity_[i] * forces[i];
      const double response = model_.counts_at_newton * std::pow(load, model_.power);
      const double counts =
          tare_[i] + std::max(0.0, response - model_.dead_zone) + model_.noise * normal();
      readings[i] = static_cast<std::uint8_t>(std::clamp(std::round(counts), 0.0, 255.0));
    }
    return frame;
  }

  [[nodiscard]] SkinCalibration tared() {
    TareFrames bare("bare", skin(), SenselType::u8);
    const std::vector<double> none(sensitivity_.size(), 0);
    for (int i = 0; i < 100; ++i) bare.add(read(none).view());
    return take_tare(blank_calibration(skin()), bare, {}).calibration;
  }

  /// Moves a body of this reach to a random place, wholly on the pad.
  void place(Body& body, double reach) {
    body.row = reach + uniform() * (model_.rows - 2 * reach);
    body.col = reach + uniform() * (model_.cols - 2 * reach);
  }

 private:
  Model model_;
  std::mt19937_64 random_;
  std::vector<double> sensitivity_;
  std::vector<double> tare_;
};

/// A body that rolls from one random place to the next, each half a second away.
class RollingBody {
 public:
  RollingBody(WeighedPad& pad, const Body& body, double wobble, double tilt)
      : pad_(pad), body_(body), from_(body), to_(body), wobble_(wobble), tilt_(tilt) {
    for (double& phase : phases_) phase = 2 * std::numbers::pi * pad.uniform();
    pad.place(from_, reach());
    pad.place(to_, reach());
  }

  /// The body in the next frame, 1/50 s later.
  [[nodiscard]] Body next() {
    constexpr int kFrames = 25;
    const double way = static_cast<double>(frame_ % kFrames) / kFrames;
    if (frame_ > 0 && frame_ % kFrames == 0) {
      from_ = to_;
      pad_.place(to_, reach());
    }
    const double time = frame_++ / 50.0;
    const double part = way * way * (3 - 2 * way);
    Body now = body_;
    now.row = from_.row + part * (to_.row - from_.row);
    now.col = from_.col + part * (to_.col - from_.col);
    now.radius *= 1 + wobble_ * std::sin(2 * time + phases_[0]);
    now.tilt_x = tilt_ * std::sin(1.3 * time + phases_[1]);
    now.tilt_y = tilt_ * std::sin(0.9 * time + phases_[2]);
    return now;
  }

 private:
  [[nodiscard]] double reach() const {
    return body_.radius * std::sqrt(body_.aspect) * (1 + wobble_) + 1;
  }

  WeighedPad& pad_;
  Body body_;
  Body from_;
  Body to_;
  double wobble_;
  double tilt_;
  double phases_[3] = {};
  int frame_ = 0;
};

}  // namespace pillarfield::core_test
