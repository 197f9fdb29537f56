#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <trocar/training/store.hpp>

namespace trocar::training {
namespace {

std::filesystem::path lock_of(const std::filesystem::path& folder, const std::string& uuid) {
  return folder / "locks" / (is_uuid(uuid) ? uuid : "unnamed");  // never a path of its own
}

}  // namespace

AttemptLock::AttemptLock(const std::filesystem::path& folder, const std::string& uuid) : m_path(lock_of(folder, uuid)) {
  std::error_code ignored;
  std::filesystem::create_directories(m_path.parent_path(), ignored);
  m_file = open(m_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (m_file < 0) return;
  if (flock(m_file, LOCK_EX | LOCK_NB) != 0) {
    close(m_file);
    m_file = -1;
    return;
  }
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

bool AttemptLock::is_held(const std::filesystem::path& folder, const std::string& uuid) {
  const int file = open(lock_of(folder, uuid).c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool held = flock(file, LOCK_SH | LOCK_NB) != 0;
  close(file);
  return held;
}

}  // namespace trocar::training
