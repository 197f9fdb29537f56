#include <trocar/core/field_hash.hpp>
#include <trocar/sim/model/motion.hpp>

namespace trocar::sim {

void add_to_hash(core::Hasher& hasher, const MotionModel& motion) noexcept { core::add_fields(hasher, motion); }

}  // namespace trocar::sim
