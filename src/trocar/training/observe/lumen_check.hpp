// Whether a tube still leads an egg from the ovary to the uterus, and whether what a cut opened is closed by clips or
// loops. Memory is taken once; the questions allocate nothing.
#pragma once

#include <array>
#include <vector>

#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/vessels/lumen.hpp>

namespace trocar::training {

class LumenCheck {
 public:
  LumenCheck() = default;
  LumenCheck(const sim::Model& model, int strand, double closing_cover);

  void update(const sim::Model& model, const sim::State& state);

  bool occluded() const { return m_occluded; }  ///< no way from the uterus to the fimbriae
  bool severed() const { return m_cut >= 0; }
  int cut_element() const { return m_cut; }        ///< of the first cut through it; -1: none
  bool stumps_closed() const { return m_closed; }  ///< severed, and a whole clip or loop on either side of every cut

 private:
  int closed_at(const sim::Model& model, const sim::State& state, double s) const;
  bool leads(int from, int to, std::int32_t cuts);

  int m_strand = -1, m_nodes = 0, m_cut = -1;
  float m_cover = 0.98f;
  std::vector<vessels::LumenSegment> m_segments;
  std::array<vessels::LumenClosure, interactions::kMaxClips + sim::kMostLoops> m_closures{};
  std::int32_t m_closure_count = 0;
  std::vector<std::int32_t> m_cuts, m_scratch;
  bool m_occluded = false, m_closed = false;
};

}  // namespace trocar::training
