#include <array>

#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/blood.hpp>

namespace trocar::training {
namespace {

/// What was lost in the last second, which is a rate.
class BloodFlow final : public Observer {
 public:
  BloodFlow(const sim::Model&, const Arguments&) {}
  void sample(const Snapshot& snapshot, double) override {
    double& second_ago = m_before[size_t(m_sample) % m_before.size()];
    const double now = blood_lost(snapshot.model, snapshot.state);
    m_flow = now - second_ago;
    second_ago = now;
    ++m_sample;
  }
  Value value(const Snapshot&) const override { return m_flow; }

 private:
  std::array<double, 50> m_before{};  ///< one a sample [m^3]
  int m_sample = 0;
  double m_flow = 0;
};

}  // namespace

const Fact kBloodFlow{
    "blood.flow_mL_min",    {}, 0, 1e4, "Blood that left vessels in the last second, as a rate.", needs_fluids,
    &remembering<BloodFlow>};

}  // namespace trocar::training
