#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

OpeningLock::OpeningLock(const fs::path& folder)
    : m_file(::open((folder / "sessions.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
  for (int tries = 0; m_file >= 0 && tries < 500 && flock(m_file, LOCK_EX | LOCK_NB) != 0; ++tries) usleep(20'000);
}

OpeningLock::~OpeningLock() {
  if (m_file >= 0) close(m_file);
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) out.push_back(at->path());
  std::sort(out.begin(), out.end());
  return out;
}

std::string read_file(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > most) return {};
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string write_file(const fs::path& path, const void* bytes, std::size_t size) {
  const std::string part = path.string() + ".part";
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0600);
  if (file < 0) return std::strerror(errno);
  const char* at = static_cast<const char*>(bytes);
  bool good = true;
  while (good && size > 0) {
    const ssize_t wrote = ::write(file, at, size);
    if (wrote < 0 && errno == EINTR) continue;
    good = wrote > 0;
    if (good) at += wrote, size -= size_t(wrote);
  }
  good = good && fsync(file) == 0;
  std::string said = good ? "" : std::strerror(errno);
  if (close(file) != 0 && said.empty()) said = std::strerror(errno);
  if (said.empty() && rename(part.c_str(), path.c_str()) != 0) said = std::strerror(errno);
  if (!said.empty()) unlink(part.c_str());
  return said;
}

void make_own_folder(const fs::path& folder) {
  const fs::path plain = folder.has_filename() ? folder : folder.parent_path();  // "data/" is "data"
  std::error_code ignored;
  if (plain.has_parent_path()) fs::create_directories(plain.parent_path(), ignored);
  mkdir(plain.c_str(), 0700);
}

fs::path own_temporary_folder() {
  std::error_code error;
  const fs::path base = fs::temp_directory_path(error);
  if (error) return {};
  const fs::path folder = base / fmt::format("trocar-{}", getuid());
  mkdir(folder.c_str(), 0700);
  struct stat info {};
  const bool ours = lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == getuid() &&
                    (info.st_mode & 077) == 0;
  return ours ? folder : fs::path();
}

}  // namespace trocar::training
