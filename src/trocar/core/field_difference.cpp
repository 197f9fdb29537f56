#include <fmt/format.h>

#include <trocar/core/field_difference.hpp>

namespace trocar::core {

std::string exact_text(double value) { return fmt::format("{}", value); }
std::string exact_text(float value) { return fmt::format("{}", value); }
std::string exact_text(long long value) { return std::to_string(value); }
std::string exact_text(const std::string& x, const std::string& y, const std::string& z) {
  return fmt::format("({} {} {})", x, y, z);
}

}  // namespace trocar::core
