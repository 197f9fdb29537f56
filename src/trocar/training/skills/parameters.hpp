// Parameters that many skills have, and what scenes lack for them.
#pragma once

#include <optional>

#include <trocar/training/skills/skill.hpp>

namespace trocar::training {

inline Parameter hand_parameter(std::string_view meaning = "the hand that does it") {
  return {"hand", ArgumentKind::hand, meaning};
}
inline Parameter number_parameter(std::string_view name, std::string_view meaning, double low, double high) {
  return {name, ArgumentKind::number, meaning, false, low, high};
}
inline Parameter range_parameter(std::string_view name, std::string_view meaning, double low, double high) {
  return {name, ArgumentKind::range, meaning, false, low, high};
}
inline Parameter word_parameter(std::string_view name, std::string_view meaning, std::vector<std::string> words) {
  return {name, ArgumentKind::word, meaning, false, 0, 0, std::move(words)};
}

inline Parameter watch_parameter() {
  return word_parameter("watch", "whether the camera shows the port meanwhile; default yes", {"yes", "no"});
}

/// Where to: a strand's place (of, at_mm, or after, before and share), a mark, an organ where it is nearest to the
/// hand's trocar, the place that bleeds, the pool.
std::vector<Parameter> place_parameters();
std::vector<Parameter> operator+(std::vector<Parameter> a, std::vector<Parameter> b);

Parameter from_end_parameter();
/// The place along a strand that `at_mm` or `from_end_mm` says [m]; nothing where neither does.
std::optional<double> arc_given(const sim::Model& model, const SkillArgs& args);

/// Handle of a half closed clip applier: its legs stand around what they will close, and can still be drawn off.
inline constexpr double kHalfClosed = 0.42;

/// Where no instrument in the hand's rack can do that.
std::string lacks_tool(const sim::Model& model, int hand, bool interactions::Abilities::*can);
std::string lacks_landmark(const sim::Model& model, int strand, const std::string& landmark);

/// A place as a skill's parameters say it.
class Place {
 public:
  Place() = default;
  Place(const sim::Model& model, const SkillArgs& args);

  bool given() const { return m_strand >= 0 || m_mark >= 0 || m_nearest >= 0 || m_bleeding || m_pool; }
  /// [m]; where there is no such place any more, the last one. @param hand  who asks
  Vec3d point(Surgeon& op, int hand) const;
  Vec3d tangent(Surgeon& op) const;  ///< of a strand or a vessel; else across what is seen
  int strand() const { return m_strand; }
  double s() const { return m_s; }
  int mark() const { return m_mark; }

  static std::string lacks(const sim::Model& model, const SkillArgs& args);

 private:
  int m_strand = -1, m_mark = -1, m_nearest = -1;
  bool m_bleeding = false, m_pool = false;
  double m_s = 0;  ///< [m]
};

/// The stretch of a strand between two landmarks: from the end of `after` to the beginning of `before` [m].
struct Stretch {
  double from = 0, to = 0;
};
Stretch stretch_of(const sim::Model& model, int strand, const std::string& after, const std::string& before);

}  // namespace trocar::training
