#include <algorithm>
#include <array>

#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/bleeder.hpp>

namespace trocar::training {
namespace {

/// A pulse is no change: the mean of two seconds says what runs through.
class VesselFlow final : public Observer {
 public:
  VesselFlow(const sim::Model&, const Arguments& a) : m_vessel(a[0].index) {}
  void sample(const Snapshot& snapshot, double) override {
    double& oldest = m_flows[size_t(m_samples++) % m_flows.size()];
    const double now = vessels::read_wall(snapshot.model.vessels.flow, snapshot.state.flow, m_vessel, 0.5).flow;
    m_sum += now - oldest;
    oldest = now;
  }
  Value value(const Snapshot&) const override {
    if (m_samples == 0) return kUnknown;
    return m_sum / double(std::min(size_t(m_samples), m_flows.size()));
  }

 private:
  std::int32_t m_vessel;
  std::array<double, 100> m_flows{};  ///< one a sample [m^3/s]
  double m_sum = 0;
  int m_samples = 0;
};

Value sealed(const Snapshot& snapshot, const Arguments& a) { return vessel_sealed(snapshot.state, a[0].index); }

std::string_view needs_vessels(const sim::Model& model) { return model.vessels.there() ? "" : "vessels"; }

std::string_view needs_vessels_and_energy(const sim::Model& model) {
  return model.vessels.there() ? needs_energy(model) : needs_vessels(model);
}

}  // namespace

const Fact kVesselFlow{
    "vessel.flow_mL_min",
    {{"of", ArgumentKind::vessel, "which"}},
    -1e4,
    1e4,
    "Mean flow through the vessel's middle over the last two seconds, positive from its start to its end; negative "
    "when reversed.",
    needs_vessels,
    &remembering<VesselFlow>};

const Fact kVesselSealed{"vessel.sealed",
                         {{"of", ArgumentKind::vessel, "which"}},
                         0,
                         1,
                         "Heat has sealed the vessel somewhere, so that it withstands three times a systolic pressure.",
                         needs_vessels_and_energy,
                         &stateless<sealed>,
                         true};

}  // namespace trocar::training
