#include <trocar/sim/stages/peristalsis.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {

void apply_peristalsis(StepContext& c) noexcept {
  const double now = double(c.state.tick) * kTick;
  for (const PeristalsisModel& p : c.model.motion.peristalsis) {
    const std::size_t organ = std::size_t(p.solid);
    for (const std::int32_t node : p.wave.nodes) c.work.wave_force[std::size_t(node)] = {0, 0, 0};
    add_wave(p.wave, c.work.organs[organ].nodes, now, c.work.wave_force);
    for (const std::int32_t node : p.wave.nodes) {
      const Vec3d f = c.work.wave_force[std::size_t(node)];
      if (f.x == 0 && f.y == 0 && f.z == 0) continue;
      tissue::NodeLoad load;
      load.node = node;
      load.f0 = vec_cast<float>(f);
      c.work.organs[organ].loads.add(load, {interactions::Owner::anchor, p.solid, 0});  // nobody asks for its reaction
    }
  }
}

}  // namespace trocar::sim
