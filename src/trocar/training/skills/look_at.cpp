#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// Places in the picture, as near as that allows; counts while the picture is at rest.
class LookAt final : public Skill {
 public:
  LookAt(const sim::Model& model, const SkillArgs& args)
      : m_place(model, args), m_time(args.number("for_s", 0)), m_distance(args.number("from_mm", 0.06)) {}

 private:
  Progress work(Surgeon& op) override {
    op.want(m_place.point(op, -1));
    op.from(m_distance);
    m_steady += op.camera().settled() ? sim::kTick : 0;
    return m_steady < m_time || !op.camera().settled() ? Progress::working : Progress::done;
  }
  Place m_place;
  double m_time, m_distance;
};

}  // namespace

const SkillKind kLookAt{
    "look_at",
    "look",
    place_parameters() +
        std::vector<Parameter>{number_parameter("for_s", "total time with the picture at rest; default 0", 0, 600),
                               number_parameter("from_mm", "distance of the lens; default 60", 10, 300)},
    30,
    "Centres a target in the picture.",
    Place::lacks,
    &making<LookAt>};

}  // namespace trocar::training
