#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>

namespace trocar::core {
namespace {

constexpr std::string_view kUnfinished = ".part";

/// The process of such a name; none where it is none, or that of another file than `name` (empty: of any).
std::optional<pid_t> writer_of(std::string_view file, std::string_view name) {
  const auto digits_before = [&file](char mark) {
    const std::size_t at = file.rfind(mark);
    const std::string_view digits = at == file.npos ? std::string_view() : file.substr(at + 1);
    const bool good = !digits.empty() && digits.size() < 10 && digits.find_first_not_of("0123456789") == digits.npos;
    file = file.substr(0, good ? at : 0);
    return good ? std::optional(std::stol(std::string(digits))) : std::nullopt;
  };
  if (!file.ends_with(kUnfinished)) return std::nullopt;
  file.remove_suffix(kUnfinished.size());
  if (!digits_before('-')) return std::nullopt;
  const std::optional<long> process = digits_before('.');
  if (!process || *process <= 0 || (!name.empty() && file != name)) return std::nullopt;
  return pid_t(*process);
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::write(file, bytes.data(), bytes.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    bytes.remove_prefix(std::size_t(wrote));
  }
  return true;
}

}  // namespace

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

std::filesystem::path unfinished_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> number{0};
  return fmt::format("{}.{}-{}{}", path.string(), ::getpid(), number++, kUnfinished);
}

std::string write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts,
                       unsigned mode) {
  struct stat there;
  const bool replaces = ::lstat(path.c_str(), &there) == 0 && S_ISREG(there.st_mode);
  if (replaces) mode = there.st_mode & 07777;
  const std::filesystem::path part = unfinished_name(path);
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode_t(mode));
  if (file < 0) return std::strerror(errno);
  bool good = !replaces || ::fchmod(file, mode_t(mode)) == 0;
  for (const std::string_view bytes : parts) good = good && write_all(file, bytes);
  good = good && ::fsync(file) == 0;
  std::string said = good ? "" : std::strerror(errno);
  if (::close(file) != 0 && said.empty()) said = std::strerror(errno);
  if (said.empty() && std::rename(part.c_str(), path.c_str()) != 0) said = std::strerror(errno);
  if (!said.empty()) ::unlink(part.c_str());
  remove_unfinished(path.has_parent_path() ? path.parent_path() : ".", path.filename().string());
  return said;
}

std::string write_file(const std::filesystem::path& path, const void* bytes, std::size_t size, unsigned mode) {
  return write_file(path, {std::string_view(static_cast<const char*>(bytes), size)}, mode);
}

void put_file(const std::filesystem::path& path, std::string_view bytes) {
  std::error_code ignored;  // what it means is told by the write
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  if (const std::string said = write_file(path, {bytes}); !said.empty())
    throw BadInput({{{path.generic_string(), 0, 0}, tr("expected a file that can be written, got \"{}\"", said)}});
}

void remove_unfinished(const std::filesystem::path& folder, const std::string& name) {
  constexpr std::chrono::minutes kOld{10};  // a program on another machine may be writing
  const auto before = std::filesystem::file_time_type::clock::now() - kOld;
  std::error_code error;
  for (auto at = std::filesystem::directory_iterator(folder, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    const std::optional<pid_t> program = writer_of(at->path().filename().string(), name);
    if (!program || ::kill(*program, 0) == 0 || errno != ESRCH) continue;
    std::error_code gone;  // another program removed it
    if (at->last_write_time(gone) < before && !gone) std::filesystem::remove(at->path(), gone);
  }
}

}  // namespace trocar::core
