#include <fstream>
#include <iterator>
#include <system_error>

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
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in) refuse("expected a readable file, got an error from the system while reading");
  return bytes;
}

}  // namespace trocar::core
