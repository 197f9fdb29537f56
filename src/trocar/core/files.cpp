#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>

namespace trocar::core {

std::string read_file(const std::filesystem::path& path, std::uint64_t most) {
  const auto refuse = [&](const std::string& message) { throw BadInput({{{path.generic_string(), 0, 0}, message}}); };
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    refuse(std::filesystem::exists(path, error) ? "expected a file, got something else"
                                                : "expected a file, got none of this name");
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > most) refuse("expected at most " + std::to_string(most) + " bytes, got " + std::to_string(size));
  // What the system says of a file's size may be wrong: no more is read than is wanted.
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  std::vector<char> part(std::size_t(1) << 16);
  while (in && bytes.size() <= most) {
    in.read(part.data(), std::streamsize(part.size()));
    bytes.append(part.data(), std::size_t(in.gcount()));
  }
  if (!in.eof() && !in.good()) refuse("expected a readable file, got an error from the system while reading");
  if (bytes.size() > most) refuse("expected at most " + std::to_string(most) + " bytes, got more");
  return bytes;
}

std::string write_file(const std::filesystem::path& path, const void* bytes, std::size_t size, unsigned mode) {
  struct stat there;
  if (::stat(path.c_str(), &there) == 0) mode = there.st_mode & 07777;
  const std::string part = path.string() + ".part";
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, mode_t(mode));
  if (file < 0) return std::strerror(errno);
  const char* at = static_cast<const char*>(bytes);
  bool good = true;
  while (good && size > 0) {
    const ssize_t wrote = ::write(file, at, size);
    if (wrote < 0 && errno == EINTR) continue;
    good = wrote > 0;
    if (good) at += wrote, size -= std::size_t(wrote);
  }
  good = good && ::fsync(file) == 0;
  std::string said = good ? "" : std::strerror(errno);
  if (::close(file) != 0 && said.empty()) said = std::strerror(errno);
  if (said.empty() && std::rename(part.c_str(), path.c_str()) != 0) said = std::strerror(errno);
  if (!said.empty()) ::unlink(part.c_str());
  return said;
}

}  // namespace trocar::core
