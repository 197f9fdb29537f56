#include <algorithm>

#include <trocar/scene/checks/predicted_cost.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

// docs/developers/computation.md; strands and folds as `trocar check` measures them.
constexpr double kLattice = 1.7, kCuttable = 2.9, kMembrane = 3.5;  // [ns] a spring and sub-step
constexpr double kStrand = 0.16;                                    // [us] an element: implicit
constexpr double kSpringsPerCell = 6;                               // of tetrahedra, and some at the border

double springs_us(double ns, double springs, int substeps) { return 1e-3 * ns * springs * std::max(1, substeps); }

}  // namespace

double predicted_us(const BodyReport& b) {
  if (b.kind == "strand") return kStrand * b.springs;
  const double ns = b.kind == "solid"                           ? kLattice
                    : b.kind == "cuttable"                      ? kCuttable
                    : b.kind == "membrane" || b.kind == "pouch" ? kMembrane
                                                                : 0;
  return springs_us(ns, b.springs, b.substeps);
}

double predicted_us(const sim::Model& model) {
  double sum = 0;
  sim::visit_bodies(
      model, sim::Overloaded{[&](sim::SolidRef r) {
                               const tissue::NetworkModel& n = model_of(model, r).network;
                               sum += springs_us(kLattice, n.springs, n.substeps);
                             },
                             [&](sim::CuttableRef r) {
                               const tissue::CuttableModel& b = model_of(model, r).body;
                               sum += springs_us(kCuttable, kSpringsPerCell * double(b.brings.size()), b.substeps);
                             },
                             [&](sim::StrandRef r) { sum += kStrand * model.strand_bodies[r.index].nodes(); },
                             [&](sim::MembraneRef r) {
                               const tissue::NetworkModel& n = model_of(model, r).sheet.network;
                               sum += springs_us(kMembrane, n.springs, n.substeps);
                             }});
  return sum;
}

}  // namespace trocar::scene
