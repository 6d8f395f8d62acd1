#include "gl/session.h"

#include <epoxy/gl.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/scene_loader.h"
#include "gl/units.h"
#include "integrators/table.h"

namespace zonal::gl {

struct Session::Frame {
  GBuffer points;
  Texture2D sum, direct;
  unsigned vertex_array = 0;

  Frame(const ShaderText& text, int width, int height)
      : points(text, width, height), sum(GL_RGBA32F, width, height), direct(GL_RGBA32F, width, height) {
    glCreateVertexArrays(1, &vertex_array);
  }
  ~Frame() { glDeleteVertexArrays(1, &vertex_array); }
};

namespace {

/// Texts of a scene file that name a file beside it become its full path.
void name_in_full(nlohmann::json& value, const std::filesystem::path& folder) {
  if (value.is_string()) {
    const std::filesystem::path file = folder / value.get<std::string>();
    std::error_code ignored;
    if (value.get<std::string>().find('.') != std::string::npos &&
        std::filesystem::is_regular_file(file, ignored))
      value = std::filesystem::absolute(file).lexically_normal().string();
  } else if (value.is_structured()) {
    for (auto& part : value) name_in_full(part, folder);
  }
}

nlohmann::json point(vec3 p) {
  return {p.x, p.y, p.z};
}

}  // namespace

Session::Session(const Context& context, ShaderText text, const std::string& scene_file)
    : text_(std::move(text)),
      file_(scene_file),
      scene_(load_scene(scene_file)),
      buffers_(std::make_unique<SceneBuffers>(scene_)),
      show_(Program::graphics(text_, "gl/show.vert", "gl/show.frag")),
      timer_(context) {}
Session::~Session() = default;

bool Session::shows_all_lights() const {
  for (const auto& light : scene_.lights())
    if (!light->is_delta()) return false;
  return true;
}

std::unique_ptr<Integrator> Session::prepare(const std::string& method, const nlohmann::json& settings,
                                             nlohmann::json* values, std::unique_ptr<Twin>* twin,
                                             std::unique_ptr<DirectLight>* direct) {
  nlohmann::json all = settings;
  const IntegratorRow& row = find_integrator(method, "view");
  if (!all.contains("occlusion")) all["occlusion"] = "none";
  if (row.has("direct") && !all.contains("direct") && !shows_all_lights()) all["direct"] = "none";
  auto integrator = row.make(all, "integrator \"" + method + "\"", values);
  *twin = make_twin(method, text_, *integrator, scene_);
  if (samples_direct(*integrator)) *direct = std::make_unique<DirectLight>(text_, scene_);
  PassStats stats;
  integrator->load(scene_, {}, stats);
  const Pass pass{.scene = scene_, .camera = scene_.camera()};
  integrator->begin_pass(pass, {}, stats);
  (*twin)->begin_pass(pass, *buffers_);
  return integrator;
}

void Session::choose(const std::string& method, const nlohmann::json& settings) {
  std::unique_ptr<Twin> twin;
  std::unique_ptr<DirectLight> direct;
  nlohmann::json values;
  auto integrator = prepare(method, settings, &values, &twin, &direct);
  // The twin reads its CPU twin: both change together.
  twin_ = std::move(twin), direct_ = std::move(direct), integrator_ = std::move(integrator);
  method_ = method, settings_ = values;
}

void Session::reload(const ShaderText& text) {
  const ShaderText old = text_;
  text_ = text;
  try {
    Program show = Program::graphics(text_, "gl/show.vert", "gl/show.frag");
    auto frame =
        frame_ ? std::make_unique<Frame>(text_, frame_->points.width(), frame_->points.height()) : nullptr;
    if (!method_.empty()) choose(method_, settings_);
    show_ = std::move(show), frame_ = std::move(frame);
  } catch (const SceneError&) {
    text_ = old;
    throw;
  }
}

void Session::draw(const Camera& camera) {
  if (!frame_ || frame_->points.width() != camera.width || frame_->points.height() != camera.height)
    frame_ = std::make_unique<Frame>(text_, camera.width, camera.height);
  Frame& f = *frame_;
  const float nothing[4] = {0, 0, 0, 0};
  glClearTexImage(f.sum.id(), 0, GL_RGBA, GL_FLOAT, nothing);
  glClearTexImage(f.direct.id(), 0, GL_RGBA, GL_FLOAT, nothing);
  times_ = {};
  timer_.begin();
  f.points.draw(*buffers_, camera, vec2(0.5f), scene_.bounds().radius);
  times_.points_ms = 1e3 * timer_.end();
  if (direct_) {
    timer_.begin();
    direct_->add(*buffers_, f.points, f.direct);
    times_.direct_ms = 1e3 * timer_.end();
  }
  if (!twin_) return;
  timer_.begin();
  twin_->gather(f.points, f.sum);
  times_.gather_ms = 1e3 * timer_.end();
}

void Session::show(unsigned framebuffer, int width, int height, float exposure) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  if (!frame_) return;
  frame_->points.bind();
  frame_->sum.bind(units::kMethod);
  frame_->direct.bind(units::kMethod + 1);
  show_.use();
  show_.set("window", ivec2(width, height));
  show_.set("exposure", exposure);
  show_.set("with_glow", shows_glow(*integrator_) ? 1 : 0);
  glBindVertexArray(frame_->vertex_array);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Image Session::radiance() const {
  const std::vector<GBuffer::Pixel> pixels = frame_->points.read();
  const std::vector<vec4> sum = frame_->sum.read_rgba(), direct = frame_->direct.read_rgba();
  Image image(frame_->points.width(), frame_->points.height());
  for (size_t i = 0; i < pixels.size(); ++i) {
    const vec3 value = vec3(direct[i]) + glm::max(vec3(sum[i]), vec3(0)) +
                       (shows_glow(*integrator_) ? pixels[i].emitted : vec3(0));
    for (int c = 0; c < 3; ++c) image.pixels[3 * i + c] = value[c];
  }
  return image;
}

void Session::save(const std::string& prefix, const Camera& camera) const {
  std::ifstream file(file_);
  std::ostringstream text;
  text << file.rdbuf();
  nlohmann::json scene = nlohmann::json::parse(text.str());
  name_in_full(scene, std::filesystem::path(file_).parent_path());
  scene.erase("$schema");
  scene["camera"] = {{"position", point(camera.position)},
                     {"look_at", point(camera.position + camera.forward * scene_.bounds().radius)},
                     {"up", point(camera.up)},
                     {"vertical_fov", camera.vertical_fov * (180 / kPi)},
                     {"exposure", camera.exposure},
                     {"resolution", {camera.width, camera.height}}};
  scene["integrator"] = settings_;
  scene["integrator"]["type"] = method_;
  ImageFile picture{.layers = {{"", radiance()}}};
  picture.metadata["integrator"] = method_;
  picture.metadata["parameters"] = settings_.dump();
  write_image(prefix + ".png", picture, camera.exposure);
  write_text(prefix + ".json", scene.dump(2) + "\n");
}

}  // namespace zonal::gl
