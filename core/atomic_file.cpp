#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "core/error.h"

namespace zonal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw SceneError(fmt::format("{}: cannot be written: {}", file, why));
}

/// Where the bytes really go: a symbolic link stays one, the file it points to is replaced.
fs::path target_of(const std::string& file) {
  std::error_code error;
  if (file.empty()) fail("\"\"", "the name is empty");
  fs::path target(file);
  if (fs::is_symlink(target, error)) {
    target = fs::weakly_canonical(target, error);
    if (error) fail(file, error.message());
  }
  if (fs::is_directory(target, error)) fail(file, "it is a folder");
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) fail(file, fmt::format("there is no folder {}", folder.string()));
  if (fs::exists(target, error) && ::access(target.c_str(), W_OK) != 0) fail(file, std::strerror(errno));
  return target;
}

/// A file under a temporary name that disappears unless it is renamed.
class Temporary {
 public:
  Temporary(const std::string& file, const fs::path& target) : file_(file), target_(target) {
    // The process number and a counter keep two writers of one target apart.
    static std::atomic<unsigned> counter{0};
    name_ = fmt::format("{}.{}-{}.part", target.string(), ::getpid(), counter++);
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(file_, std::strerror(errno));
  }
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void write(const char* bytes, size_t size) {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, bytes, std::min(size, size_t{1} << 30));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail(file_, std::strerror(written < 0 ? errno : ENOSPC));
      bytes += written, size -= static_cast<size_t>(written);
    }
  }
  void rename_to_target() {
    // Network file systems report a full disk only here.
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0 || std::rename(name_.c_str(), target_.c_str()) != 0) fail(file_, std::strerror(errno));
    name_.clear();
  }

 private:
  std::string file_, name_;
  fs::path target_;
  int descriptor_ = -1;
};

}  // namespace

void write_atomically(const std::string& file, const void* bytes, size_t size) {
  Temporary temporary(file, target_of(file));
  temporary.write(static_cast<const char*>(bytes), size);
  temporary.rename_to_target();
}

void check_can_write(const std::string& file) {
  const Temporary temporary(file, target_of(file));
}

}  // namespace zonal
