#include <fstream>
#include <system_error>
#include <vector>

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

}  // namespace trocar::core
