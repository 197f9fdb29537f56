#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/mechanisms/urdf_warnings.hpp>

namespace trocar::scene {
namespace {

constexpr double kLongestLength = 5;     // [m] of a medical robot: beyond, another unit is likely
constexpr double kMillimetresFrom = 50;  // [m] in centimetres this would be half a metre: longer is rare
constexpr double kMostAngle = 2 * portable::pi + 0.01, kMostTurns = 4 * portable::pi + 0.01;  // [rad]

/// The numbers of an attribute; none where it is missing.
std::vector<double> numbers_of(const XmlElement& e, const char* name) {
  std::vector<double> out;
  const XmlAttribute* a = e.attribute(name);
  std::istringstream words(a ? a->value : std::string());
  for (std::string word; words >> word;) out.push_back(core::is_decimal(word) ? core::to_double(word) : 0);
  return out;
}

/// Limits of several turns are rare; whole numbers beyond one turn are degrees.
bool is_in_degrees(double angle) {
  return std::fabs(angle) > kMostTurns || (std::fabs(angle) > kMostAngle && angle == std::round(angle));
}

class Suspicions {
 public:
  explicit Suspicions(const std::string& file) : m_file(file) {}

  std::vector<core::Fault> of(const XmlElement& root) {
    for (const XmlElement& e : root.children)
      if (e.name == "joint") joint(e);
    sizes(root);
    if (m_longest.value > 0)
      warn(m_longest, tr("a length of {:.4g} m, as URDF states metres. The file is probably in {}: {}", m_longest.value,
                         m_longest.value < kMillimetresFrom ? tr("centimetres or millimetres") : tr("millimetres"),
                         m_longest.value < kMillimetresFrom ? tr("convert its lengths to metres")
                                                            : tr("divide its lengths by 1000")));
    if (m_angle.value > 0)
      warn(m_angle, tr("an angle of {:.4g} rad, as URDF states radians. The file is probably in degrees: multiply its "
                       "angles by pi/180",
                       m_angle.value));
    return std::move(m_warnings);
  }

 private:
  /// The largest of its kind, and where it is.
  struct Largest {
    double value = 0;
    int line = 0, column = 0;
    void take(double v, const XmlElement& e) {
      if (std::fabs(v) <= value) return;
      *this = {std::fabs(v), e.line, e.column};
    }
  };

  void warn(const Largest& at, std::string words) {
    m_warnings.push_back({{m_file, at.line, at.column}, std::move(words)});
  }
  void length_of(const XmlElement& e, const char* name) {
    for (const double v : numbers_of(e, name))
      if (std::fabs(v) > kLongestLength) m_longest.take(v, e);
  }

  /// Places and shapes, wherever they are.
  void sizes(const XmlElement& e) {
    if (e.name == "origin") {
      length_of(e, "xyz");
      for (const double v : numbers_of(e, "rpy"))
        if (std::fabs(v) > kMostAngle) m_angle.take(v, e);
    } else if (e.name == "box" || e.name == "cylinder" || e.name == "sphere") {
      for (const char* name : {"size", "length", "radius"}) length_of(e, name);
    }
    for (const XmlElement& child : e.children) sizes(child);
  }

  void joint(const XmlElement& e) {
    const XmlAttribute *name = e.attribute("name"), *type = e.attribute("type");
    if (!name || !type || (type->value != "revolute" && type->value != "prismatic")) return;
    const bool turns = type->value == "revolute";
    const std::string shown = core::printable(name->value);
    const XmlElement* limit = e.child("limit");
    if (!limit)
      return warn({0, e.line, e.column},
                  turns ? tr("the joint \"{}\" has no <limit>, which URDF requires. It is taken as half a turn either "
                             "way: add its limits, or make it \"continuous\"",
                             shown)
                        : tr("the joint \"{}\" has no <limit>, which URDF requires. It is taken as 100 mm either way: "
                             "add its limits",
                             shown));
    const std::vector<double> low = numbers_of(*limit, "lower"), high = numbers_of(*limit, "upper");
    const double lower = low.empty() ? 0 : low[0], upper = high.empty() ? 0 : high[0];
    if (lower == upper)
      warn({0, limit->line, limit->column},
           tr("the joint \"{}\" cannot move: its limits are {:g} and {:g}{}. Write its range as \"lower\" and "
              "\"upper\", or make it \"fixed\"",
              shown, lower, upper, low.empty() && high.empty() ? tr(", as the file has none") : std::string()));
    for (const double v : {lower, upper})
      if (turns ? is_in_degrees(v) : std::fabs(v) > kLongestLength) (turns ? m_angle : m_longest).take(v, *limit);
  }

  const std::string& m_file;
  std::vector<core::Fault> m_warnings;
  Largest m_longest, m_angle;
};

}  // namespace

std::vector<core::Fault> urdf_warnings(const XmlElement& root, const std::string& file) {
  return Suspicions(file).of(root);
}

}  // namespace trocar::scene
