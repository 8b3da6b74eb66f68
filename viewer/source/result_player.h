#pragma once

#include <memory>
#include <string>

#include "pillarfield/result_stream.h"
#include "viewer/source/live_view.h"

namespace pillarfield::viewer {

/// Shows the results that another program writes into a ring, as they come, with the contacts that
/// it found. The time of a field is the sensor's, counted from the start of the player.
class ResultPlayer final : public LiveView {
 public:
  ResultPlayer(std::unique_ptr<ResultStream> stream, const std::string& name,
               std::shared_ptr<Curves> curves);
  ~ResultPlayer() override;

  [[nodiscard]] const SourceInfo& info() const override;
  [[nodiscard]] PlayerState state() const override;
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
