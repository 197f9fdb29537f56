#include <array>

#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

double in_m3(std::int64_t picolitres) { return fluids::kM3PerPicolitre * double(picolitres); }

/// What lay there when it began was lost before.
double lost_so_far(const Look& look) {
  return in_m3(look.state.fluids.ledger.in[size_t(fluids::Source::kBled)].blood -
               look.model.wet.pool_at_start.blood);
}

Value lost(const Look& look, const Arguments&) { return lost_so_far(look); }
Value pool(const Look& look, const Arguments&) {
  return in_m3(at(look.state.fluids.ledger, fluids::Place::kPool).total());
}

/// What was lost in the last second, which is a rate.
class Flow final : public Observer {
 public:
  Flow(const sim::Model&, const Arguments&) {}
  void sample(const Look& look, double) override {
    double& second_ago = m_before[size_t(m_sample) % m_before.size()];
    const double now = lost_so_far(look);
    m_flow = now - second_ago;
    second_ago = now;
    ++m_sample;
  }
  Value value(const Look&) const override { return m_flow; }

 private:
  std::array<double, 50> m_before{};  ///< one a sample [m^3]
  int m_sample = 0;
  double m_flow = 0;
};

class Bleeding final : public Observer {
 public:
  Bleeding(const sim::Model&, const Arguments&) {}
  void sample(const Look& look, double) override {
    if (m_began < 0 && lost_so_far(look) > 0) m_began = look.now();
  }
  Value value(const Look& look) const override { return m_began < 0 ? kUnknown : Value(look.now() - m_began); }

 private:
  double m_began = -1;
};

}  // namespace

const Fact kBloodLost{"blood.lost_mL", {}, 0, 1e4, "What has left vessels so far.", needs_fluids, &stateless<lost>};
const Fact kBloodFlow{
    "blood.flow_mL_min", {}, 0, 1e4, "What has left vessels in the last second, as a rate.", needs_fluids,
    &remembering<Flow>};
const Fact kBloodSince{
    "blood.since_s",       {}, 0, 36000, "How long ago the first blood left a vessel. Unknown before.", needs_fluids,
    &remembering<Bleeding>};
const Fact kPoolVolume{"pool.volume_mL", {}, 0, 1e4, "What stands in the pool.", needs_fluids, &stateless<pool>};

}  // namespace trocar::training
