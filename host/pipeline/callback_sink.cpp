#include <utility>

#include "pillarfield/pipeline.h"

namespace pillarfield {
namespace {

class CallbackSink final : public ForceSink {
 public:
  explicit CallbackSink(std::function<void(const SolvedFrame&)> call) : call_(std::move(call)) {}
  void append(const SolvedFrame& frame) override { call_(frame); }

 private:
  std::function<void(const SolvedFrame&)> call_;
};

}  // namespace

std::unique_ptr<ForceSink> callback_sink(std::function<void(const SolvedFrame&)> call) {
  return std::make_unique<CallbackSink>(std::move(call));
}

}  // namespace pillarfield
