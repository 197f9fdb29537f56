#include <algorithm>
#include <cmath>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

/// The longest look so far. Counted in ticks, so that a look of a second is one of a second.
class SeenFor final : public Observer {
 public:
  SeenFor(const sim::Model&, const Arguments& a) : m_mark(a[0].index), m_share(a[1].number()) {}
  void sample(const Snapshot& snapshot, double dt) override {
    const bool seen = sim::visible_share(snapshot.model, snapshot.state, m_mark) >= m_share;
    m_now = seen ? m_now + std::lround(dt / sim::kTick) : 0;
    m_longest = std::max(m_longest, m_now);
  }
  Value value(const Snapshot&) const override { return double(m_longest) / core::kTicksPerSecond; }

 private:
  int m_mark;
  double m_share;
  long m_now = 0, m_longest = 0;  ///< [ticks]
};

}  // namespace

const Fact kMarkSeenFor{
    "mark.seen_for_s",
    {{"of", ArgumentKind::mark, "the mark"},
     {"share", ArgumentKind::number, "share of sample points from which the mark counts as seen", true, 0, 1}},
    0,
    36000,
    "The longest uninterrupted time that the mark has been seen so far.",
    anywhere,
    &remembering<SeenFor>};

}  // namespace trocar::training
