#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace pillarfield::viewer {

/// Pool of reusable objects. One thread acquires; any thread may release the last copy of an
/// object, also after the pool is destroyed.
template <class Thing>
class ObjectPool {
 public:
  /// Makes at most `most` objects with `make`, on demand.
  ObjectPool(std::size_t most, std::function<std::unique_ptr<Thing>()> make)
      : most_(most), make_(std::move(make)), shelf_(std::make_shared<Shelf>()) {
    shelf_->things.reserve(most);  // Release must not throw.
  }

  /// Returns an object in the state of its last release; null where all are in use.
  [[nodiscard]] std::shared_ptr<Thing> acquire() {
    std::unique_ptr<Thing> thing = shelf_->take();
    if (thing == nullptr) {
      if (made_ == most_) return nullptr;
      thing = make_();
      ++made_;
    }
    return {thing.release(), [shelf = shelf_](Thing* given) { shelf->put(given); }};
  }

 private:
  struct Shelf {
    std::unique_ptr<Thing> take() {
      const std::scoped_lock lock(mutex);
      if (things.empty()) return nullptr;
      std::unique_ptr<Thing> thing = std::move(things.back());
      things.pop_back();
      return thing;
    }
    void put(Thing* given) {
      const std::scoped_lock lock(mutex);
      things.emplace_back(given);
    }

    std::mutex mutex;
    std::vector<std::unique_ptr<Thing>> things;
  };

  std::size_t most_;
  std::size_t made_ = 0;
  std::function<std::unique_ptr<Thing>()> make_;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace pillarfield::viewer
