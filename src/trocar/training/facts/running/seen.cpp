#include <cmath>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

/// Which of the marks have had their look.
class SeenShare final : public Observer {
 public:
  SeenShare(const sim::Model&, const Arguments& a)
      : m_marks(a[0].marks), m_time(std::lround(a[1].number() / sim::kTick)), m_looked(m_marks.size(), 0) {}
  void sample(const Snapshot& snapshot, double dt) override {
    const long passed = std::lround(dt / sim::kTick);
    for (size_t i = 0; i < m_marks.size(); ++i) {
      if (m_looked[i] >= m_time) continue;
      m_looked[i] = sim::visible(snapshot.model, snapshot.state, m_marks[i]) ? m_looked[i] + passed : 0;
      m_seen += m_looked[i] >= m_time;
    }
  }
  Value value(const Snapshot&) const override {
    return m_marks.empty() ? 0.0 : double(m_seen) / double(m_marks.size());
  }

 private:
  std::vector<std::int32_t> m_marks;
  long m_time;
  std::vector<long> m_looked;  ///< (marks) [ticks] without a break
  int m_seen = 0;
};

}  // namespace

const Fact kMarksSeen{"marks.seen_share",
                      {{"of", ArgumentKind::marks, "marks to be seen"},
                       {"for_s", ArgumentKind::number, "uninterrupted time in view for each", true, 0, 60}},
                      0,
                      1,
                      "The share of these marks that have been in view for that time so far.",
                      anywhere,
                      &remembering<SeenShare>};

}  // namespace trocar::training
