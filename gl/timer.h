#pragma once
/// Seconds the GPU takes for the commands between `begin` and `end`.

#include "core/stop.h"
#include "gl/context.h"

namespace zonal::gl {

class Timer {
 public:
  /// Queries are meaningless on a software renderer: there the queue is finished on both sides and the clock
  /// read.
  explicit Timer(const Context& context);
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  void begin();
  /// Waits for the result.
  double end();

 private:
  bool software_;
  unsigned query_ = 0;
  Clock::time_point start_;
};

}  // namespace zonal::gl
