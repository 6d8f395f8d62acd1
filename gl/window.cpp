#include "gl/window.h"

#include <epoxy/gl.h>
// GLFW must not bring its own GL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "gl/viewer.h"
#include "integrators/table.h"

namespace zonal::gl {
namespace {

/// GLFW from its first call to its last.
struct Library {
  Library() {
    if (glfwInit()) return;
    const char* why = nullptr;
    glfwGetError(&why);
    throw SceneError(fmt::format(
        "zonal view: found no display ({}), expected one (or render without a window: zonal render "
        "--backend gl)",
        why ? why : "GLFW does not start"));
  }
  ~Library() { glfwTerminate(); }
};

struct Window {
  GLFWwindow* handle;
  Window(int width, int height, const std::string& title) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, kMajor);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, kMinor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    handle = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!handle) {
      const char* why = nullptr;
      glfwGetError(&why);
      throw SceneError(fmt::format("zonal view: found no OpenGL {}.{} core window ({}), expected one", kMajor,
                                   kMinor, why ? why : "unknown"));
    }
    glfwMakeContextCurrent(handle);
  }
  ~Window() { glfwDestroyWindow(handle); }
};

/// Dear ImGui from its first call to its last.
struct Panel {
  explicit Panel(GLFWwindow* window) {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 450");
  }
  ~Panel() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
};

void method_box(Viewer& viewer) {
  if (!ImGui::BeginCombo("method", viewer.session.method().c_str())) return;
  for (const std::string& name : twin_names())
    if (ImGui::Selectable(name.c_str(), name == viewer.session.method())) viewer.change_method(name);
  ImGui::EndCombo();
}

/// Every parameter of the method, from the table that the command line and the scene files read.
void parameter_boxes(Viewer& viewer) {
  const nlohmann::json settings = viewer.session.settings();
  for (const ParamInfo& p : find_integrator(viewer.session.method(), "view").params()) {
    const nlohmann::json& value = settings[p.name];
    char text[64] = {};
    const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    std::memcpy(text, shown.data(), std::min(shown.size(), sizeof text - 1));
    ImGui::SetNextItemWidth(120);
    if (ImGui::InputText(p.name.c_str(), text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue))
      viewer.set(p.name, text);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s\n%s %s", p.help.c_str(), p.range.c_str(), p.unit.c_str());
  }
}

void draw_panel(Viewer& viewer, char* prefix, size_t prefix_size) {
  ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
  ImGui::Begin("zonal", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  const Session::Times& t = viewer.session.times();
  ImGui::Text("%.2f ms: points %.2f, direct %.2f, gather %.2f", t.frame_ms(), t.points_ms, t.direct_ms,
              t.gather_ms);
  const std::vector<float> history(viewer.frame_times.begin(), viewer.frame_times.end());
  ImGui::PlotLines("frame ms", history.data(), int(history.size()), 0, nullptr, 0.0f, FLT_MAX, {240, 48});
  method_box(viewer);
  parameter_boxes(viewer);
  ImGui::SliderFloat("exposure", &viewer.fly.camera.exposure, 1e-2f, 1e2f, "%.2f",
                     ImGuiSliderFlags_Logarithmic);
  ImGui::InputText("save as", prefix, prefix_size);
  if (ImGui::Button("save scene and picture")) viewer.save(prefix);
  ImGui::SameLine();
  if (ImGui::Button("reload shaders")) viewer.reload();
  ImGui::TextUnformatted("fly: W A S D Q E, right mouse button turns, shift is faster");
  if (!viewer.message.empty()) ImGui::TextColored({1, 0.4f, 0.3f, 1}, "%s", viewer.message.c_str());
  ImGui::End();
}

void fly_by_keys(GLFWwindow* window, Viewer& viewer, float seconds) {
  if (ImGui::GetIO().WantCaptureKeyboard) return;
  const auto held = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS ? 1.0f : 0.0f; };
  const vec3 way(held(GLFW_KEY_D) - held(GLFW_KEY_A), held(GLFW_KEY_E) - held(GLFW_KEY_Q),
                 held(GLFW_KEY_W) - held(GLFW_KEY_S));
  viewer.fly.move(way, seconds, held(GLFW_KEY_LEFT_SHIFT) > 0);
}

/// Turns by how far the mouse went while its right button was held.
void turn_by_mouse(GLFWwindow* window, Viewer& viewer, glm::dvec2& last) {
  glm::dvec2 now;
  glfwGetCursorPos(window, &now.x, &now.y);
  const bool held = glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
  if (held && !ImGui::GetIO().WantCaptureMouse)
    viewer.fly.turn(float(now.x - last.x) * 0.004f, float(last.y - now.y) * 0.004f);
  last = now;
}

}  // namespace

void run_window(const WindowOptions& options) {
  const Library library;
  const Window window(options.width, options.height, "zonal: " + options.scene);
  const auto context = Context::of_window();
  const Panel panel(window.handle);
  Viewer viewer(*context, options.scene, options.method, options.settings, options.shader_folder);
  char prefix[256] = "view";
  glm::dvec2 mouse(0);
  size_t next = 0;
  double last = glfwGetTime();
  while (!glfwWindowShouldClose(window.handle)) {
    glfwPollEvents();
    if (next < options.script.size()) {
      viewer.act(options.script[next++]);
      if (viewer.wanted_size.x > 0)
        glfwSetWindowSize(window.handle, viewer.wanted_size.x, viewer.wanted_size.y);
      viewer.wanted_size = ivec2(0);
    } else if (!options.script.empty()) {
      break;
    }
    const double now = glfwGetTime();
    fly_by_keys(window.handle, viewer, static_cast<float>(std::min(now - last, 0.1)));
    turn_by_mouse(window.handle, viewer, mouse);
    last = now;
    if (viewer.shaders_changed()) viewer.reload();

    int width = 0, height = 0;
    glfwGetFramebufferSize(window.handle, &width, &height);
    viewer.frame(width, height);
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    draw_panel(viewer, prefix, sizeof prefix);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glfwSwapBuffers(window.handle);
    if (!options.script.empty()) context->check("zonal view: " + options.script[next - 1]);
  }
}

}  // namespace zonal::gl
