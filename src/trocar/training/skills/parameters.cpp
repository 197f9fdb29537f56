#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/marks.hpp>
#include <trocar/training/skills/parameters.hpp>

namespace trocar::training {
const Argument& SkillArgs::operator()(std::string_view name) const {
  static const Argument none;
  for (size_t i = 0; i < m_kind->parameters.size() && i < m_arguments->size(); ++i)
    if (m_kind->parameters[i].name == name) return (*m_arguments)[i];
  return none;
}

double SkillArgs::number(std::string_view name, double otherwise) const {
  const Argument& a = (*this)(name);
  return a.given ? a.number() : otherwise;
}

Parameter from_end_parameter() { return number_parameter("from_end_mm", "or: distance from the rod's end", 0, 1000); }

std::optional<double> arc_given(const sim::Model& model, const SkillArgs& args) {
  if (args("at_mm").given) return args("at_mm").number();
  if (!args("from_end_mm").given) return std::nullopt;
  return std::max(0.0, model.strand_bodies[size_t(args("of").index)].length() - args("from_end_mm").number());
}

std::vector<Parameter> place_parameters() {
  return {{"of", ArgumentKind::strand, "the rod of the place", false},
          {"at_mm", ArgumentKind::number, "distance from the rod's beginning", false, 0, 1000},
          from_end_parameter(),
          {"after", ArgumentKind::landmark, "landmark of the rod; the place is beyond its end", false},
          {"before", ArgumentKind::landmark, "landmark; the place is before its beginning", false},
          {"share", ArgumentKind::number, "share of the distance from `after` to `before`", false, 0, 1},
          {"mark", ArgumentKind::mark, "or: the middle of a mark", false},
          {"nearest_of", ArgumentKind::mark, "or: the point of an organ that is nearest to the hand's port", false},
          word_parameter("there", "or: the bleeding place, or the deepest place of the pool", {"bleeding", "pool"})};
}

std::vector<Parameter> operator+(std::vector<Parameter> a, std::vector<Parameter> b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string lacks_tool(const sim::Model& model, int hand, bool interactions::Abilities::*can) {
  if (can_take(model.hands[size_t(hand)], can)) return {};
  return tr("the rack at the trocar \"{}\" has no {}", model.hands[size_t(hand)].name, interactions::kinds_that(can));
}

std::string lacks_landmark(const sim::Model& model, int strand, const std::string& landmark) {
  if (strand < 0) return {};
  for (const sim::LandmarkModel& l : model.strands[size_t(strand)].landmarks)
    if (l.name == landmark) return {};
  return tr("the strand \"{}\" has no landmark \"{}\"", model.strands[size_t(strand)].name, landmark);
}

Stretch stretch_of(const sim::Model& model, int strand, const std::string& after, const std::string& before) {
  Stretch s{0, model.strand_bodies[size_t(strand)].length()};
  for (const sim::LandmarkModel& l : model.strands[size_t(strand)].landmarks) {
    if (l.name == after) s.from = l.to;
    if (l.name == before) s.to = l.from;
  }
  return s;
}

Place::Place(const sim::Model& model, const SkillArgs& args) {
  if (args("of").given) {
    m_strand = args("of").index;
    const Stretch between = stretch_of(model, m_strand, args("after").word, args("before").word);
    const double share = args.number("share", 0.5);
    m_s = arc_given(model, args).value_or(between.from + (between.to - between.from) * share);
  }
  if (args("mark").given) m_mark = args("mark").index;
  if (args("nearest_of").given) m_nearest = args("nearest_of").index;
  m_bleeding = args.equals("there", "bleeding");
  m_pool = args.equals("there", "pool");
}

namespace {

Vec3d nearest_of(const Surgeon& op, int mark, Vec3d to) {
  const int organ = op.model().targets[size_t(mark)].index;
  const tissue::Skin& skin = op.model().skin(organ);
  const tissue::NodeView nodes = nodes_of(op.model(), op.state(), organ);
  Vec3d nearest = tissue::skin_point(nodes, skin, 0);
  for (int v = 1; v < skin.size(); ++v)
    if (const Vec3d p = tissue::skin_point(nodes, skin, v); length(p - to) < length(nearest - to)) nearest = p;
  return nearest;
}

}  // namespace

Vec3d Place::point(Surgeon& op, int hand) const {
  const sim::Bleeder& bleeder = op.model().vessels.bleeder;
  if (m_strand >= 0) return op.point(m_strand, m_s);
  if (m_mark >= 0) return place_of_mark(op.model(), op.state(), m_mark);
  if (m_nearest >= 0) return nearest_of(op, m_nearest, op.arm(hand).port);
  if (m_pool && hand >= 0)
    if (const std::optional<Vec3d> deepest = op.deepest_pool(hand)) return *deepest;
  return bleeder.vessel >= 0 ? op.vessel_spot(bleeder.vessel, bleeder.s).place : op.arm(std::max(0, hand)).tip;
}

Vec3d Place::tangent(Surgeon& op) const {
  const sim::Bleeder& bleeder = op.model().vessels.bleeder;
  if (m_strand >= 0) return op.tangent(m_strand, m_s);
  if (m_bleeding && bleeder.vessel >= 0) return op.vessel_spot(bleeder.vessel, bleeder.s).along;
  return {1, 0, 0};
}

std::string Place::lacks(const sim::Model& model, const SkillArgs& args) {
  if (args.equals("there", "bleeding") && model.vessels.bleeder.vessel < 0) return "the scene has no bleeder";
  if (args("nearest_of").given && model.targets[size_t(args("nearest_of").index)].kind != sim::VisibilityTarget::organ)
    return tr("\"{}\" is not an organ", model.targets[size_t(args("nearest_of").index)].name);
  if (args.equals("there", "pool") && !model.wet.there) return "the scene has no fluids";
  const Argument& of = args("of");
  for (const char* landmark : {"after", "before"})
    if (of.given && args(landmark).given)
      if (std::string lack = lacks_landmark(model, of.index, args(landmark).word); !lack.empty()) return lack;
  const double farthest = std::max(args.number("at_mm", 0), args.number("from_end_mm", 0));
  if (of.given && farthest > model.strand_bodies[size_t(of.index)].length())
    return tr("the strand \"{}\" is only {:.1f} mm long", model.strands[size_t(of.index)].name,
              1e3 * model.strand_bodies[size_t(of.index)].length());
  return {};
}

}  // namespace trocar::training
