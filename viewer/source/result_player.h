#pragma once

#include <memory>
#include <string>

#include "pillarfield/result_stream.h"
#include "viewer/source/live_player.h"

namespace pillarfield::viewer {

/// Shows the results that another program writes into a ring, as they come, with the contacts that
/// it found. The time of a field is the sensor's, counted from the start of the player.
class ResultPlayer final : public Player, public LiveControl {
 public:
  ResultPlayer(std::unique_ptr<ResultStream> stream, const std::string& name,
               std::shared_ptr<Curves> curves);
  ~ResultPlayer() override;

  [[nodiscard]] const SourceInfo& info() const override;
  void play() override;
  void pause() override;
  void seek(std::uint64_t /*frame*/) override {}
  void step(std::int64_t /*frames*/) override {}
  void set_speed(double /*speed*/) override {}
  void set_rate(double /*rate_hz*/) override {}
  void set_loop(bool /*loop*/) override {}
  void set_follow(bool /*follow*/) override {}
  void set_contacts(bool wanted) override;
  void set_peak(bool wanted) override;
  [[nodiscard]] PlayerState state() const override;
  [[nodiscard]] PlayerStatistics statistics() const override;
  [[nodiscard]] std::optional<ShownField> take() override;
  void on_new_field(std::function<void()> wake) override;
  [[nodiscard]] LiveControl* live() override { return this; }

  /// Does nothing but say who can.
  void tare() override;
  void record(const std::filesystem::path& path) override;
  void stop_recording() override {}
  [[nodiscard]] LiveStatus status() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield::viewer
