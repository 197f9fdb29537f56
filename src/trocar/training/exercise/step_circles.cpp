#include <algorithm>

#include <trocar/training/exercise/step_circles.hpp>

namespace trocar::training {
namespace {

/// What has to be closed or done before the step counts.
std::vector<int> waits_for(const StepRule& rule) {
  std::vector<int> all = rule.after;
  const auto note = [&all](int step) { all.push_back(step); };
  all.insert(all.end(), rule.needs.begin(), rule.needs.end());
  rule.when.each_needed_step(note);
  // Of several events one is enough.
  if (rule.on.causes().size() == 1) rule.on.causes()[0].while_true.each_needed_step(note);
  return all;
}

class CircleSearch {
 public:
  explicit CircleSearch(const std::vector<StepRule>& steps) : m_steps(steps), m_seen(steps.size(), Seen::no) {}

  /// The way from a step back to where it has been, with that step at its end.
  const std::vector<int>& way() const { return m_way; }
  bool leads_back(int step) {
    if (m_seen[std::size_t(step)] == Seen::good) return false;
    m_way.push_back(step);
    if (m_seen[std::size_t(step)] == Seen::on_the_way) return true;
    m_seen[std::size_t(step)] = Seen::on_the_way;
    for (const int before : waits_for(m_steps[std::size_t(step)]))
      if (leads_back(before)) return true;
    m_seen[std::size_t(step)] = Seen::good;
    m_way.pop_back();
    return false;
  }

 private:
  enum class Seen { no, on_the_way, good };
  const std::vector<StepRule>& m_steps;
  std::vector<Seen> m_seen;
  std::vector<int> m_way;
};

}  // namespace

std::vector<int> circle_of(const std::vector<StepRule>& steps) {
  CircleSearch search(steps);
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (search.leads_back(int(i))) {
      const std::vector<int>& way = search.way();
      return {std::find(way.begin(), way.end(), way.back()), way.end() - 1};
    }
  return {};
}

}  // namespace trocar::training
