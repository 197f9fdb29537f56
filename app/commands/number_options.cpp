#include "commands/number_options.hpp"

#include <optional>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

CLI::Validator number(const std::string& expected, bool (*within)(double, double, double), double low, double high) {
  const auto check = [=](std::string& text) {
    const bool good = core::is_decimal(text) && within(core::to_double(text), low, high);
    return good ? std::string() : tr("expected {}, got '{}'", expected, text);
  };
  return CLI::Validator(check, "");
}

std::string with_unit(std::string bounds, const std::string& unit) {
  if (!unit.empty()) bounds += " " + unit;
  return bounds;
}

}  // namespace

CLI::Validator number_between(double low, double high, const std::string& unit) {
  const std::string expected = with_unit(tr("a number from {:g} to {:g}", low, high), unit);
  return number(
      expected, [](double v, double from, double to) { return v >= from && v <= to; }, low, high);
}

CLI::Validator number_above(double low, double high, const std::string& unit) {
  const std::string expected = with_unit(tr("a number above {:g}, at most {:g}", low, high), unit);
  return number(
      expected, [](double v, double from, double to) { return v > from && v <= to; }, low, high);
}

CLI::Validator whole_number(std::int64_t low, std::int64_t high) {
  const auto check = [=](std::string& text) {
    const std::optional<std::int64_t> value = core::to_integer(text);
    if (!value || *value < low || *value > high)
      return tr("expected a whole number from {} to {}, got '{}'", low, high, text);
    text = std::to_string(*value);
    return std::string();
  };
  return CLI::Validator(check, "");
}

}  // namespace trocar::app
