#include <trocar/training/observe/marks.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A mark in the middle of the picture from a distance, as far as scope and trocar allow along its normal, the horizon
/// level: what an oblique scope's light post and a camera's head are for.
class View final : public Skill {
 public:
  View(const sim::Model&, const SkillArgs& args)
      : m_mark(args("mark").index), m_distance(args.number("from_mm", 0.05)), m_time(args.number("for_s", 0)) {}

 private:
  Progress work(Surgeon& op) override {
    const Vec3d at = place_of_mark(op.model(), op.state(), m_mark);
    const std::optional<Vec3d> normal = normal_of_mark(op.model(), op.state(), m_mark);
    op.camera().view(at, normal, m_distance);
    m_steady = op.camera().settled() ? m_steady + sim::kTick : 0;
    return m_steady > m_time ? Progress::done : Progress::working;
  }
  int m_mark;
  double m_distance, m_time;
};

}  // namespace

const SkillKind kView{"view",
                      "look",
                      {{"mark", ArgumentKind::mark, "the mark to look at"},
                       number_parameter("from_mm", "distance of the lens; default 50", 10, 300),
                       number_parameter("for_s", "time with the picture at rest; default 0", 0, 600)},
                      30,
                      "Brings a mark into the picture's middle along its normal, as far as endoscope and port allow, "
                      "with a level horizon.",
                      nothing,
                      &making<View>};

}  // namespace trocar::training
