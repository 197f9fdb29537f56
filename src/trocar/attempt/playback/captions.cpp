#include <algorithm>

#include <trocar/attempt/playback/captions.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/json_fields.hpp>

namespace trocar::attempt {
std::vector<Doing> doings_of_result(const std::string& result_json) {
  std::vector<Doing> doings;
  const Json result = training::json_in(result_json);
  const Json::json_pointer at("/surgeon/performed");
  if (!result.is_object() || !result.contains(at) || !result[at].is_array()) return doings;
  for (const Json& d : result[at])
    if (d.is_object() && d.contains("tick") && d["tick"].is_number_unsigned())
      doings.push_back({d["tick"].get<std::uint64_t>(), training::text_in(d, "goal"), training::text_in(d, "skill")});
  std::stable_sort(doings.begin(), doings.end(), [](const Doing& a, const Doing& b) { return a.tick < b.tick; });
  return doings;
}

Captions::Captions(const std::string& result_json, const training::Steps& steps)
    : m_found(findings_of_result(result_json)), m_doings(doings_of_result(result_json)) {
  for (std::size_t i = 0; i < m_found.steps.size() && i < steps.size(); ++i) m_found.steps[i].hint = steps[i].hint;
}

Caption Captions::at(std::uint64_t tick) const {
  Caption caption;
  const GuideState* guide = m_found.guide_at(tick);
  if (guide && guide->current >= 0 && std::size_t(guide->current) < m_found.steps.size()) {
    const training::StepStatus& step = m_found.steps[std::size_t(guide->current)];
    caption.step = step.name;
    caption.hint = step.hint;
  }
  const auto after = std::upper_bound(m_doings.begin(), m_doings.end(), tick,
                                      [](std::uint64_t t, const Doing& d) { return t < d.tick; });
  if (after == m_doings.begin()) return caption;
  const Doing& now = *(after - 1);
  caption.doing = now.goal.empty()    ? core::with_capital(now.skill)
                  : now.skill.empty() ? core::with_capital(now.goal)
                                      : tr("{}: {}", core::with_capital(now.goal), now.skill);
  return caption;
}

}  // namespace trocar::attempt
