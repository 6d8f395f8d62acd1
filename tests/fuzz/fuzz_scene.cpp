// libFuzzer target for the scene loader: any bytes either load or end in a SceneError of one line. Anything
// else (a crash, another exception, a second line, a hang) is a finding.
//
//     cmake -B build-fuzz -DZONAL_FUZZ=ON -DZONAL_SANITIZE=address,undefined -DCMAKE_CXX_COMPILER=clang++-16
//     -G Ninja ninja -C build-fuzz fuzz_scene && mkdir -p corpus && cp scenes/*/*.json
//     tests/scene_files/*.json corpus/ build-fuzz/fuzz_scene -max_total_time=600 -max_len=16384
//     -dict=tests/fuzz/scene.dict corpus

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "core/scene_loader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Relative file names in the input find the test scenes' pictures and meshes when started from the
  // repository.
  const std::string file = "tests/scene_files/fuzz.json";
  try {
    const zonal::Scene scene = zonal::parse_scene(text, file, {.frame = static_cast<int>(size % 12)});
    // What was accepted can be traced.
    const zonal::Camera& camera = scene.camera();
    const zonal::Hit hit = scene.intersect(camera.position, camera.forward);
    if (hit.found()) scene.emitted(scene.surface(hit, camera.forward));
  } catch (const zonal::SceneError& error) {
    const std::string message = error.what();
    if (message.find_first_of("\r\n") != std::string::npos || message.rfind(file, 0) != 0) std::abort();
  }
  return 0;
}
