#include <trocar/sim/model/motion.hpp>

namespace trocar::sim {

void add_to_hash(core::Hasher& h, const MotionModel& motion) noexcept {
  const BreathingModel& b = motion.breathing;
  if (b.there()) {
    h.add(b.period), h.add(b.way);
    h.add(b.organs), h.add(b.strands), h.add(b.membranes);
  }
  for (const PeristalsisModel& p : motion.peristalsis) {
    h.add(p.solid);
    add_to_hash(h, p.wave);
  }
}

}  // namespace trocar::sim
