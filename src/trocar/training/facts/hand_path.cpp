#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

/// The tip's way so far.
class Path final : public Observer {
 public:
  Path(const sim::Model& model, const Arguments& a) : m_hand(size_t(a[0].index)) {
    m_before = tip_of(model, sim::initial_state(model), m_hand);
  }
  void sample(const Snapshot& snapshot, double) override {
    const Vec3d now = tip_of(snapshot.model, snapshot.state, m_hand);
    m_way += length(now - m_before);
    m_before = now;
  }
  Value value(const Snapshot&) const override { return m_way; }

 private:
  size_t m_hand;
  Vec3d m_before;
  double m_way = 0;
};

}  // namespace

const Fact kHandPath{"hand.path_mm",
                     {{"hand", ArgumentKind::hand, "whose instrument"}},
                     0,
                     1e6,
                     "Path length of the instrument's tip so far.",
                     anywhere,
                     &remembering<Path>};

}  // namespace trocar::training
