#include "gl/timer.h"

#include <epoxy/gl.h>

namespace zonal::gl {

Timer::Timer(const Context& context) : software_(context.info().software) {
  if (!software_) glCreateQueries(GL_TIME_ELAPSED, 1, &query_);
}
Timer::~Timer() {
  if (query_) glDeleteQueries(1, &query_);
}

void Timer::begin() {
  if (!software_) return glBeginQuery(GL_TIME_ELAPSED, query_);
  glFinish();
  start_ = Clock::now();
}

double Timer::end() {
  if (software_) {
    glFinish();
    return seconds_since(start_);
  }
  glEndQuery(GL_TIME_ELAPSED);
  GLuint64 nanoseconds = 0;
  glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &nanoseconds);
  return 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace zonal::gl
