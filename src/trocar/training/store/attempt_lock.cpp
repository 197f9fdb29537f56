#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/training/store/store.hpp>

namespace trocar::training {
namespace {

std::filesystem::path lock_of(const std::filesystem::path& folder, const std::string& uuid) {
  return folder / "locks" / (is_uuid(uuid) ? uuid : "unnamed");  // never a path of its own
}

/// Is the file that is open still the one of this name?
bool is_named(int file, const std::filesystem::path& path) {
  struct stat open_one {
  }, named{};
  return fstat(file, &open_one) == 0 && stat(path.c_str(), &named) == 0 && open_one.st_dev == named.st_dev &&
         open_one.st_ino == named.st_ino;
}

/// The locked file, or -1. Somebody may be asking about it just now, or have swept it away between our two calls.
int locked(const std::filesystem::path& path) {
  for (int tries = 0; tries < 20; ++tries) {
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0) return -1;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && is_named(file, path)) return file;
    close(file);
    usleep(5000);
  }
  return -1;
}

}  // namespace

AttemptLock::AttemptLock(const std::filesystem::path& folder, const std::string& uuid) : m_path(lock_of(folder, uuid)) {
  std::error_code ignored;
  std::filesystem::create_directories(m_path.parent_path(), ignored);
  m_file = locked(m_path);
  if (m_file < 0) return;
  // Real blocks, so that a disk that fills up meanwhile still has room for what matters.
  if (posix_fallocate(m_file, 0, kRoom) != 0 && ftruncate(m_file, 0) != 0) return;
}

AttemptLock::~AttemptLock() { release(); }

AttemptLock::AttemptLock(AttemptLock&& other) noexcept
    : m_path(std::move(other.m_path)), m_file(std::exchange(other.m_file, -1)) {}

AttemptLock& AttemptLock::operator=(AttemptLock&& other) noexcept {
  release();
  m_path = std::move(other.m_path);
  m_file = std::exchange(other.m_file, -1);
  return *this;
}

void AttemptLock::give_room() {
  if (m_file >= 0 && ftruncate(m_file, 0) == 0) fsync(m_file);
}

void AttemptLock::release() {
  if (m_file < 0) return;
  unlink(m_path.c_str());
  close(m_file);
  m_file = -1;
}

void AttemptLock::sweep(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::directory_iterator at(folder / "locks", error);
  for (; !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    const int file = open(at->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && is_named(file, at->path())) unlink(at->path().c_str());
    close(file);
  }
}

bool AttemptLock::is_held(const std::filesystem::path& folder, const std::string& uuid) {
  const int file = open(lock_of(folder, uuid).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool held = flock(file, LOCK_SH | LOCK_NB) != 0;
  close(file);
  return held;
}

}  // namespace trocar::training
