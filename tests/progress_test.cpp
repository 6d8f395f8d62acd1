// What the progress line says, and that it keeps quiet when told to.
#include "core/progress.h"

#include <gtest/gtest.h>

namespace zonal {
namespace {

TEST(Progress, durations_read_well) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");
  EXPECT_EQ(duration_text(3725), "1 h 02 min");
  EXPECT_EQ(duration_text(-1), "0 s");
}

TEST(Progress, time_left_is_proportional_to_what_is_left) {
  EXPECT_EQ(progress_text("box", {.pass = 2, .fraction = 0.25, .seconds = 10}),
            "box: pass 3, 25 %, 10 s gone, 30 s left");
  EXPECT_EQ(progress_text("box", {.pass = 0, .fraction = 0, .seconds = 10}), "box: pass 1, 0 %, 10 s gone");
  EXPECT_EQ(progress_text("projecting", {.pass = -1, .fraction = 0.5, .seconds = 3}),
            "projecting: 50 %, 3 s gone, 3 s left");
}

TEST(Progress, a_log_gets_no_line_before_its_time) {
  std::FILE* log = std::tmpfile();
  {
    ProgressPrinter printer("box", false, log);
    for (int i = 0; i < 100; ++i) printer.update({.fraction = 0.5, .seconds = 1});
  }
  EXPECT_EQ(std::ftell(log), 0);
  std::fclose(log);
}

}  // namespace
}  // namespace zonal
