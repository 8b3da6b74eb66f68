#include "streams/ring/cut_guard.h"

#include <sys/mman.h>

#include <mutex>

namespace pillarfield {
namespace {

thread_local CutGuard* guard_of_thread = nullptr;
struct sigaction handler_before = {};

}  // namespace

CutGuard::CutGuard() {
  static std::mutex installing;
  const std::scoped_lock lock(installing);
  struct sigaction now = {};
  sigaction(SIGBUS, nullptr, &now);
  if ((now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == on_bus_error) return;
  handler_before = now;
  struct sigaction action = {};
  action.sa_sigaction = on_bus_error;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  sigaction(SIGBUS, &action, nullptr);
}

void CutGuard::begin() { guard_of_thread = this; }

void CutGuard::end() {
  if (guard_of_thread == this) guard_of_thread = nullptr;
}

void CutGuard::on_bus_error(int /*signal*/, siginfo_t* info, void* /*context*/) {
  if (guard_of_thread != nullptr && guard_of_thread->replace(info->si_addr)) return;
  // The access is repeated, and ends as it would have without this class.
  sigaction(SIGBUS, &handler_before, nullptr);
}

bool CutGuard::replace(const void* accessed) {
  const auto* const at = static_cast<const std::byte*>(accessed);
  if (at < memory_.data() || at >= memory_.data() + memory_.size()) return false;
  is_cut_ = 1;
  return mmap(memory_.data(), memory_.size(), PROT_READ | PROT_WRITE,
              MAP_PRIVATE | MAP_FIXED | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
}

}  // namespace pillarfield
