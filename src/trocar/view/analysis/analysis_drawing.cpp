#include <algorithm>

#include <trocar/view/analysis/analysis_drawing.hpp>

namespace trocar::view {
namespace {

render::DrawItem item_of(const FalseColourMesh& mesh, std::uint16_t part) {
  render::DrawItem item;
  item.mesh = mesh.handle();
  item.part = part;
  item.material.shading = render::Shading::vertex_colour;
  item.material.two_sided = true;
  item.material.wetness = 0;  // a highlight would say another figure
  return item;
}

}  // namespace

void AnalysisDrawing::list(const sim::State& state, const AnalysisOptions& o, const OrganBeside* beside,
                           const std::function<std::uint16_t(Measured, std::size_t)>& part_of, render::Frame& frame) {
  // What lies inside shall be seen through what lies over it.
  const auto style = o.springs || o.pressure ? render::DrawStyle::transparent : render::DrawStyle::shaded;
  const auto list_all = [&](const std::vector<FalseColourMesh>& meshes, Measured kind, bool lines) {
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      if (!meshes[i].there()) continue;
      if (!lines && o.solvers && beside && kind == Measured::organ && int(i) == beside->organ) continue;
      render::DrawItem item = item_of(meshes[i], part_of(kind, i));
      if (lines)
        item.material.shading = render::Shading::unlit;
      else
        item.style = style;
      frame.items.push_back(item);
    }
  };
  const auto list_bodies = [&](const auto& of, bool lines) {
    list_all(of.organs(), Measured::organ, lines);
    list_all(of.strands(), Measured::strand, lines);
    list_all(of.membranes(), Measured::membrane, lines);
  };
  if (o.springs) {
    if (!m_springs) m_springs.emplace(*m_model);
    m_springs->update(state, o, *m_backend);
    list_bodies(*m_springs, true);
  }
  if (o.pressure && m_model->vessels.there()) list_vessels(state, o, part_of, frame);
  if (o.strain) {
    if (!m_surfaces) m_surfaces.emplace(*m_model);
    m_surfaces->update(state, o, *m_backend);
    list_bodies(*m_surfaces, false);
  }
  if (o.solvers && beside) list_solvers(state, o, *beside, part_of(Measured::organ, std::size_t(beside->organ)), frame);
  if (!o.forces) return;
  m_arrows.update(forces_of(*m_model, state), o, *m_backend);
  if (m_arrows.mesh().there()) frame.items.push_back(item_of(m_arrows.mesh(), part_of(Measured::tools, 0)));
}

void AnalysisDrawing::list_solvers(const sim::State& state, const AnalysisOptions& o, const OrganBeside& beside,
                                   std::uint16_t part, render::Frame& frame) {
  if (!m_solvers) m_solvers.emplace(*m_model);
  m_solvers->update(state, beside, o, frame.camera.position, *m_backend);
  if (m_solvers->surface().there()) frame.items.push_back(item_of(m_solvers->surface(), part));
  if (!m_solvers->wires().there()) return;
  render::DrawItem wires = item_of(m_solvers->wires(), part);
  wires.material.shading = render::Shading::unlit;
  frame.items.push_back(wires);
}

void AnalysisDrawing::list_vessels(const sim::State& state, const AnalysisOptions& o,
                                   const std::function<std::uint16_t(Measured, std::size_t)>& part_of,
                                   render::Frame& frame) {
  const auto& all = m_model->vessels.list;
  if (m_vessels.empty())
    for (const bool veins : {false, true}) {
      if (std::none_of(all.begin(), all.end(), [veins](const sim::Vessel& v) { return v.vein == veins; })) continue;
      m_vessels.emplace_back(*m_model, veins, *m_backend, Detail{}, VesselDrawing::Lie::below_too);
      m_vessel_colours.emplace_back();
      m_are_veins.push_back(veins);
    }
  for (std::size_t i = 0; i < m_vessels.size(); ++i) {
    m_vessels[i].update(state);
    FalseColourMesh& shown = m_vessel_colours[i];
    const bool changed = shown.buffer.indices != m_vessels[i].buffer().indices;
    shown.buffer = m_vessels[i].buffer();
    shown.buffer.rest.clear();
    shown.value = m_vessels[i].pressures();
    for (std::size_t v = 0; v < shown.value.size(); ++v)
      shown.buffer.paint[v] = paint_shown_as(colour_of_pressure(o, double(shown.value[v])));
    shown.show(*m_backend, changed);
    if (!shown.there()) continue;
    frame.items.push_back(item_of(shown, part_of(m_are_veins[i] ? Measured::veins : Measured::arteries, 0)));
  }
}

}  // namespace trocar::view
