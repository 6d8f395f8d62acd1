#pragma once
/// Says when to end: someone asked (Ctrl-C, a closed window) or the time is over. Cheap enough to ask per pixel.

#include <atomic>
#include <chrono>

namespace zonal {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Stop {
 public:
  Stop() = default;
  /// `asked` may be null; `deadline` is a point of the steady clock, or its maximum for none.
  Stop(const std::atomic<bool>* asked, Clock::time_point deadline) : asked_(asked), deadline_(deadline) {}

  bool asked() const { return asked_ && asked_->load(std::memory_order_relaxed); }
  bool late() const { return deadline_ != Clock::time_point::max() && Clock::now() > deadline_; }
  bool operator()() const { return asked() || late(); }

 private:
  const std::atomic<bool>* asked_ = nullptr;
  Clock::time_point deadline_ = Clock::time_point::max();
};

}  // namespace zonal
