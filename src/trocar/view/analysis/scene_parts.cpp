#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/analysis/scene_parts.hpp>

namespace trocar::view {

SceneParts::SceneParts(const sim::Model& model, const std::vector<std::string>& kinds)
    : vessel_kinds(std::uint16_t(kinds.size())) {
  const auto add = [this](const std::string& name, PartGroup group) {
    list.push_back({name, group});
    return std::uint16_t(list.size());
  };
  const auto begins = [this] { return std::uint16_t(list.size() + 1); };
  first.organ = begins();
  for (int i = 0; i < model.organs(); ++i) add(model.organ_name(i), PartGroup::organs);
  first.tube = begins();
  for (const sim::StrandAnatomy& s : model.strands) add(s.name, PartGroup::tubes);
  first.fold = begins();
  for (const sim::DrawnFold& s : model.drawn_folds) add(s.name, PartGroup::folds);
  first.membrane = begins();
  for (const sim::MembraneBody& m : model.membranes)  // a closed one is a hollow organ
    add(m.name, m.sheet.closed() ? PartGroup::organs : PartGroup::folds);
  first.vessel = begins();
  for (const std::string& kind : kinds) add(kind, PartGroup::vessels);
  first.wall = begins();
  for (const sim::WallModel& w : model.walls) add(w.name, PartGroup::walls);
  first.cavity = add("cavity", PartGroup::walls);
  first.tool = begins();
  for (const sim::HandModel& h : model.hands) add(h.name, PartGroup::instruments);
  first.scope = add("endoscope", PartGroup::instruments);
  first.clips = add("clips", PartGroup::clips);
  first.mark = begins();
  for (const sim::MarkModel& m : model.marks) add(m.name, PartGroup::marks);
  if (model.wet.there) {
    first.liquid = add("blood and water", PartGroup::fluids);
    first.smoke = add("smoke", PartGroup::fluids);
  }
  first.object = begins();
  interactions::visit_objects(model,
                              [&](auto, BodyId object) { add(sim::name_of(model, object), PartGroup::objects); });
}

std::size_t FirstParts::of(BodyId body) const {
  switch (body.kind()) {
    case BodyKind::organ:
      return organ + body.index();
    case BodyKind::strand:
      return tube + body.index();
    case BodyKind::membrane:
      return membrane + body.index();
    default:
      return 0;
  }
}

std::uint16_t SceneParts::of(Measured kind, std::size_t i) const {
  switch (kind) {
    case Measured::organ:
      return std::uint16_t(first.of(BodyId::organ(i)));
    case Measured::strand:
      return std::uint16_t(first.of(BodyId::strand(i)));
    case Measured::membrane:
      return std::uint16_t(first.of(BodyId::membrane(i)));
    case Measured::arteries:
      return first.vessel;
    case Measured::veins:
      return std::uint16_t(first.vessel + vessel_kinds - 1);
    case Measured::tools:
      break;
  }
  return 0;
}

PartStyle style_of(const std::vector<PartStyle>& styles, std::uint16_t part) {
  return part > 0 && part <= styles.size() ? styles[part - std::size_t(1)] : PartStyle::shaded;
}

void apply(const std::vector<PartStyle>& styles, render::Frame& frame) {
  if (styles.empty()) return;
  std::erase_if(frame.items, [&](const render::DrawItem& i) { return style_of(styles, i.part) == PartStyle::hidden; });
  for (render::DrawItem& i : frame.items) {
    const PartStyle style = style_of(styles, i.part);
    if (style == PartStyle::transparent) i.style = render::DrawStyle::transparent;
    if (style == PartStyle::wireframe) i.style = render::DrawStyle::wireframe;
  }
}

}  // namespace trocar::view
