#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/following.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

class Followed final : public Observer {
 public:
  Followed(const sim::Model& model, const Arguments& a)
      : m_following({a[2].number(), a[3].number(), a[4].number(), a[5].number(), a[6].number()}, model, a[0].index,
                    a[1].word) {}
  void sample(const Snapshot& snapshot, double dt) override {
    std::array<Vec3d, sim::kMaxTools> tips{};
    for (size_t h = 0; h < hands(snapshot.model); ++h) tips[h] = tip_of(snapshot.model, snapshot.state, h);
    m_following.update(snapshot.model, snapshot.state, {tips.data(), hands(snapshot.model)}, dt);
  }
  Value value(const Snapshot&) const override { return m_following.done(); }

 private:
  Following m_following;
};

}  // namespace

const Fact kStrandFollowed{
    "strand.followed",
    {{"of", ArgumentKind::strand, "which"},
     {"from", ArgumentKind::landmark, "landmark where following starts, for example a tube's fimbriae"},
     {"to_mm", ArgumentKind::number, "end of following, from the strand's start"},
     {"speed_mm_s", ArgumentKind::number, "at most", true, 1, 1000},
     {"gap_mm", ArgumentKind::number, "length of a hidden stretch that may be skipped"},
     {"pause_s", ArgumentKind::number, "following restarts after this time out of view"},
     {"touch_mm", ArgumentKind::number, "an instrument's tip within this distance counts like a view"}},
    0,
    1,
    "The strand has been followed from that landmark back to there, in view or with an instrument's tip.",
    anywhere,
    &remembering<Followed>,
    true};

}  // namespace trocar::training
