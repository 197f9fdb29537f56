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
