#include <algorithm>
#include <cmath>

#include <trocar/interactions/clip.hpp>
#include <trocar/interactions/cut.hpp>
#include <trocar/interactions/needle.hpp>
#include <trocar/interactions/piece_contact.hpp>
#include <trocar/sim/step.hpp>
#include <trocar/sim/tearing.hpp>
#include <trocar/sim/visibility.hpp>

namespace trocar::sim {
namespace {

using interactions::Owner;

interactions::TissueView tissue_of(const StepContext& c) noexcept {
  return {c.model.bodies, c.state.strands, {c.work.surfaces.data(), size_t(c.model.organs())}, c.work.sheets};
}

void tell(StepContext& c, Event::Kind kind, int tool, int index) noexcept {
  if (c.report.event_count < kMaxEvents - kRoomForTears) c.report.events[c.report.event_count++] = {kind, tool, index};
}

bool finite(const ToolInput& t) noexcept {
  return std::isfinite(t.yaw) && std::isfinite(t.pitch) && std::isfinite(t.roll) && std::isfinite(t.depth) &&
         std::isfinite(t.handle);
}

float stepped(float from, float to, float most) noexcept { return from + std::clamp(to - from, -most, most); }

constexpr double kParked = 0.012;  // [m] an instrument is changed with its tip this deep: in the trocar's sleeve

constexpr double kIntoWall = 0.0003;  // [m] a tick

/// The memory of which side of each strand the hand's instrument is on.
std::span<Vec3f> sides_of(StepContext& c, size_t t) noexcept {
  const size_t each = c.state.tool_side.size() / c.model.hands.size();
  return {c.state.tool_side.data() + t * each, each};
}

/// Puts the instrument down and takes number `wanted` of the rack.
void change_instrument(StepContext& c, size_t t, std::int32_t wanted) noexcept {
  interactions::ToolState& tool = c.state.tools[t];
  std::int32_t* magazine = c.state.magazine.data() + t * size_t(kMaxRack);
  magazine[tool.instrument] = tool.clips_left;
  interactions::ToolState next;
  next.yaw = tool.yaw;
  next.pitch = tool.pitch;
  next.roll = tool.roll;
  next.depth = tool.depth;
  next.slipped = tool.slipped;
  next.changes = tool.changes + 1;
  next.instrument = wanted;
  next.clips_left = magazine[wanted];
  tool = next;
  interactions::start_here(next, c.state.touches[t]);
  for (Vec3f& side : sides_of(c, t)) side = {};
  const size_t each = c.state.sheet_side.size() / c.model.hands.size(), membranes = c.model.membranes.size();
  std::fill_n(c.state.sheet_side.begin() + std::ptrdiff_t(t * each), each, Vec3f{});
  std::fill_n(c.state.sheet_near.begin() + std::ptrdiff_t(t * membranes), membranes, std::uint8_t(0));
  tell(c, Event::exchanged, int(t), wanted);
}

/// What would go into a wall stays at it.
void stop_at_walls(StepContext& c, size_t t, const kinematics::FulcrumPose& wanted,
                   const kinematics::FulcrumPose& before) noexcept {
  for (const WallModel& wall : c.model.walls) {
    const interactions::Surface surface{&wall.skin, &wall.pose, {}};
    const interactions::WallStop stop =
        interactions::stop_at_walls(c.model.tool(c.state, t), wanted, before, {&surface, 1}, c.state.tools[t]);
    if (stop.stopped) c.work.wall_stops[t] = stop;
  }
}

/// One hand follows its input. While it wants another instrument it lets go of the tissue, draws back and changes.
void move_hand(StepContext& c, size_t t) noexcept {
  const ToolInput& in = c.input.tools[t];
  interactions::ToolState& tool = c.state.tools[t];
  const bool known = in.instrument >= 0 && size_t(in.instrument) < c.model.hands[t].rack.size();
  if (!known) c.report.flags |= StepReport::kBadInput;
  interactions::ToolCommand command{pose_of(in), double(in.handle)};
  if (known && in.instrument != tool.instrument) {
    command = {tool.pose(), 0};
    if (tool.holds == 0) command.pose.depth = kParked;
    if (tool.holds == 0 && tool.depth <= kParked) change_instrument(c, t, in.instrument);
  }
  const kinematics::FulcrumPose wanted = command.pose, before = tool.pose();
  // At a wall the way in is of no use: most of the speed goes along it.
  if (c.state.touches[t].near(interactions::kWallBody, 0))
    command.pose.depth = std::min(command.pose.depth, tool.depth + kIntoWall);
  interactions::follow(c.model.tool(c.state, t), command, kTick, tool);
  stop_at_walls(c, t, wanted, before);
}

// 1. Hands: instruments and scope follow the input, no faster than hands can.
void move_hands(StepContext& c) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    c.work.wall_stops[t] = {};
    if (finite(c.input.tools[t]))
      move_hand(c, t);
    else
      c.report.flags |= StepReport::kBadInput;
  }
  const ScopeInput& in = c.input.scope;
  if (!finite({in.yaw, in.pitch, in.roll, in.depth, in.post})) {
    c.report.flags |= StepReport::kBadInput;
    return;
  }
  const kinematics::FulcrumPose goal = kinematics::clamped(pose_of(in), c.model.scope.limits);
  ScopeInput& s = c.state.scope;
  s.yaw = stepped(s.yaw, float(goal.yaw), 0.004f);
  s.pitch = stepped(s.pitch, float(goal.pitch), 0.004f);
  s.roll = stepped(s.roll, float(goal.roll), 0.008f);
  s.depth = stepped(s.depth, float(goal.depth), 0.0006f);
  s.post = stepped(s.post, in.post, 0.008f);
}

/// Where organs' nodes are: their States change places when they advance.
void view_organs(StepContext& c) noexcept {
  for (int i = 0; i < c.model.organs(); ++i) c.work.nodes[size_t(i)] = nodes_of(c.model, c.state, i);
}

interactions::Holders holders_of(const StepContext& c) noexcept {
  return {c.model.bodies, c.state.strands, c.work.nodes, c.work.skins};
}

/// Bodies in the given order, shared out over threads; they write nothing in common.
template <class F>
void for_each(core::ThreadPool* pool, std::span<const int> order, F&& body) noexcept {
  auto one = [&](int k) noexcept { body(size_t(order[size_t(k)])); };
  if (pool) {
    core::run(*pool, int(order.size()), one);
    return;
  }
  for (int k = 0; k < int(order.size()); ++k) one(k);
}

void pose_sheet(StepContext& c, size_t i) noexcept {
  const MembraneModel& m = c.model.membranes[i];
  const tissue::NodeView nodes = view_of(m.sheet.network, c.state.membranes[i].network);
  tissue::pose_skin(nodes, m.skin, c.work.sheet_poses[i]);
  c.work.sheets[i] = {{&m.skin, &c.work.sheet_poses[i], nodes},
                      c.state.torn[i],
                      m.sheet.network.fixed,
                      0.5 * m.sheet.thickness,
                      m.pinch_reach};
}

void pose_cuttable(StepContext& c, size_t i) noexcept {
  const size_t organ = c.model.solids.size() + i;
  tissue::make_current(c.model.cuttables[i].body, c.state.cuttables[i], c.work.cuttable_work[i]);
  tissue::update(c.model.cuttables[i].body, c.state.cuttables[i], c.work.cuttable_skins[i]);
  tissue::pose_skin(c.work.nodes[organ], *c.work.skins[organ], c.work.poses[organ]);
}

void pose_organ(StepContext& c, size_t i) noexcept {
  const size_t solids = c.model.solids.size();
  if (i < solids)
    tissue::pose_skin(c.work.nodes[i], *c.work.skins[i], c.work.poses[i]);
  else
    pose_cuttable(c, i - solids);
  c.work.surfaces[i] = {c.work.skins[i], &c.work.poses[i], c.work.nodes[i]};
}

// 2. Skins: x = W q, boxes.
void pose_skins(StepContext& c) noexcept {
  view_organs(c);
  const size_t organs = size_t(c.model.organs());
  for_each(c.work.pool, c.work.skin_order, [&c, organs](size_t i) noexcept {
    if (i < organs)
      pose_organ(c, i);
    else
      pose_sheet(c, i - organs);
  });
  for (size_t i = 0; i < c.model.walls.size(); ++i)
    c.work.surfaces[organs + i] = {&c.model.walls[i].skin, &c.model.walls[i].pose, {}};
}

constexpr double kHangingDamping = 0.02;  // [s] times stiffness: fat and folds that carry an organ yield slowly

void hang(std::span<const tissue::Anchor> anchors, size_t organ, interactions::NetworkLoads& loads) noexcept {
  for (const tissue::Anchor& a : anchors) {
    tissue::NodeLoad load;
    load.node = a.node;
    load.k = float(a.k);
    load.d = float(a.k * kHangingDamping);
    load.x0 = vec_cast<float>(a.x0);
    load.f0 = vec_cast<float>(a.k * (a.x0 - vec_cast<double>(load.x0)));
    loads.add(load, {Owner::anchor, std::int32_t(organ), 0});
  }
}

// 3. Loads start afresh with the springs that hang organs in space.
void hang_organs(StepContext& c) noexcept {
  for (interactions::NetworkLoads& l : c.work.organ_loads) l.clear();
  for (interactions::StrandLoads& l : c.work.strand_loads) l.clear();
  for (interactions::NetworkLoads& l : c.work.membrane_loads) l.clear();
  const size_t solids = c.model.solids.size();
  for (size_t i = 0; i < solids; ++i) hang(c.model.solids[i].anchors, i, c.work.organ_loads[i]);
  for (size_t i = 0; i < c.model.cuttables.size(); ++i)
    hang(c.model.cuttables[i].body.anchors, solids + i, c.work.organ_loads[solids + i]);
}

void record_organ_cut(StepContext& c, size_t t, size_t organ) noexcept {
  State& s = c.state;
  interactions::Cut& cut = s.cuts[size_t(s.cut_count++)];
  cut = {};
  cut.solid = std::int32_t(organ);
  cut.tool = std::int32_t(t);
  cut.tips_visible = jaw_tips_visible(c.model, c.state, int(t));
  cut.tick = s.tick;
}

bool blades_near(const StepContext& c, size_t t, size_t organ, double margin) noexcept {
  const interactions::ToolShape& shape = c.work.shapes[t];
  return c.work.poses[organ].bounds.near_segment(shape.pivot, shape.frame.tip, margin);
}

/// Blades that have just closed sever springs of lattices.
void cut_lattices(StepContext& c, size_t t) noexcept {
  State& s = c.state;
  const geometry::Blade blade = interactions::closed_blades(c.model.tool(s, t), c.work.shapes[t]);
  for (size_t i = 0; i < c.model.solids.size(); ++i) {
    if (!blades_near(c, t, i, 0.005)) continue;
    if (s.cut_count == interactions::kMaxCuts) return;  // what cannot be recorded is not cut
    const SolidModel& solid = c.model.solids[i];
    const int severed =
        interactions::cut_organ(blade, solid.network, solid.fine, s.solids[i], s.parted[i], c.work.parts);
    if (severed > 0) record_organ_cut(c, t, i);
  }
}

/// Closing blades part the cells of organs that can be cut.
void cut_cuttables(StepContext& c, size_t t, const geometry::Blade& blade) noexcept {
  State& s = c.state;
  for (size_t i = 0; i < c.model.cuttables.size(); ++i) {
    const size_t organ = c.model.solids.size() + i;
    if (!blades_near(c, t, organ, c.model.tool(s, t).jaw_length)) continue;
    if (s.cut_count == interactions::kMaxCuts) return;
    const geometry::CutBook book =
        tissue::cut(c.model.cuttables[i].body, blade, s.cuttables[i], c.work.cuttable_work[i]);
    if (book.snapped + book.parted > 0) pose_cuttable(c, i);  // nodes have moved to the blade
    if (book.full) c.report.flags |= StepReport::kBookFull;
    if (book.parted > 0) record_organ_cut(c, t, organ);
  }
}

/// Where in the book these blades' cut of a membrane's strand stands that was made in this tick; else its end.
int place_in_book(const State& s, size_t t, std::int32_t strand) noexcept {
  for (int i = 0; i < s.cut_count; ++i) {
    const interactions::Cut& cut = s.cuts[size_t(i)];
    if (cut.tick == s.tick && cut.tool == std::int32_t(t) && cut.strand == strand) return i;
  }
  return s.cut_count;
}

/// Blades that have just closed part the folds they closed in; blades that are closing part closed walls, which they
/// would push away.
void cut_folds(StepContext& c, size_t t, const geometry::Blade& blade, bool closed_walls) noexcept {
  State& s = c.state;
  const interactions::ToolShape& shape = c.work.shapes[t];
  for (size_t i = 0; i < c.model.membranes.size(); ++i) {
    const MembraneModel& m = c.model.membranes[i];
    if (m.sheet.closed() != closed_walls) continue;
    if (!m.cuttable || !c.work.sheet_poses[i].bounds.near_segment(shape.pivot, shape.frame.tip, 0.005)) continue;
    const int place = place_in_book(s, t, m.strand);
    if (place == interactions::kMaxCuts) continue;  // what cannot be recorded is not cut
    const interactions::FoldCut fold =
        interactions::cut_membrane(blade, m.sheet, m.depth, s.membranes[i], s.torn[i], c.work.parts);
    if (fold.severed == 0) continue;
    interactions::Cut& cut = s.cuts[size_t(place)];
    if (place == s.cut_count) {
      ++s.cut_count;
      cut = {};
      cut.tick = s.tick;
      cut.tool = std::int32_t(t);
    }
    cut.membrane = std::int32_t(i);
    cut.fold = fold.depth;
    cut.tips_visible = jaw_tips_visible(c.model, c.state, int(t));
  }
}

/// What closing blades cut before they meet.
void cut_flesh(StepContext& c, size_t t) noexcept {
  const auto closed = [](const MembraneModel& m) { return m.sheet.closed(); };
  const bool walls = std::any_of(c.model.membranes.begin(), c.model.membranes.end(), closed);
  if (c.model.cuttables.empty() && !walls) return;
  const std::optional<geometry::Blade> blade =
      interactions::sweep_of_blades(c.model.tool(c.state, t), c.work.shapes[t], c.state.tools[t]);
  if (!blade) return;
  cut_cuttables(c, t, *blade);
  if (walls) cut_folds(c, t, *blade, true);
}

/// A grip has ended: did it slip, or did the hand let go?
void tell_lost(StepContext& c, size_t t, int slips_before) noexcept {
  tell(c, c.state.tools[t].slipped > slips_before ? Event::slipped : Event::released, int(t), -1);
}

// 4. Jaws: grip, clip, cut.
void work_jaws(StepContext& c) noexcept {
  const interactions::TissueView view = tissue_of(c);
  State& s = c.state;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolModel& model = c.model.tool(s, t);
    interactions::ToolState& tool = s.tools[t];
    c.work.shapes[t] = interactions::shape_of(model, tool.pose(), tool.aperture);
    const int held = tool.holds, slips = tool.slipped;
    interactions::update_grip(model, c.work.shapes[t], view, tool);
    if (held == 0 && tool.holds > 0) tell(c, Event::grasped, int(t), tool.hold[0].body);
    if (held > 0 && tool.holds == 0) tell_lost(c, t, slips);
    c.work.shapes[t] = interactions::shape_of(model, tool.pose(), tool.aperture);
    if (model.kind == interactions::ToolKind::clip_applier) {
      const int clips = tool.clips_left;
      const bool fired =
          update_clip_applier(model, c.work.shapes[t], int(t), view, s.strands,
                              jaw_tips_visible(c.model, c.state, int(t)), s.tick, tool, {s.clips, s.clip_count});
      if (fired) {
        const int clip = s.clip_count - 1;
        tell(c, s.clips[size_t(clip)].strand < 0 ? Event::dropped_clip : Event::clipped, int(t), clip);
      } else if (tool.clips_left < clips) {
        c.report.flags |= StepReport::kBookFull;
      }
    } else if (model.kind == interactions::ToolKind::scissors) {
      const int before = s.cut_count;
      cut_flesh(c, t);
      const bool armed = tool.armed != 0;
      update_scissors(model, c.work.shapes[t], int(t), view, s.strands, jaw_tips_visible(c.model, c.state, int(t)),
                      s.tick, tool, {s.cuts, s.cut_count});
      if (armed && !tool.armed) {
        cut_lattices(c, t);
        cut_folds(c, t, interactions::closed_blades(model, c.work.shapes[t]), false);
        if (s.cut_count == interactions::kMaxCuts) c.report.flags |= StepReport::kBookFull;
      }
      for (int cut = before; cut < s.cut_count; ++cut) tell(c, Event::cut, int(t), cut);
    }
  }
}

constexpr double kNearSheet = 0.03;  // [m]

/// An instrument on folds. Far from one that it was not near before there is nothing to do, and nothing to forget.
void touch_sheets(StepContext& c, size_t t, interactions::Touching& touching) noexcept {
  size_t triangles = 0;
  for (const MembraneModel& m : c.model.membranes) triangles += m.sheet.triangles.size();
  size_t at = t * triangles * size_t(interactions::kSheetParts);
  const interactions::ToolShape& shape = c.work.shapes[t];
  for (size_t i = 0; i < c.model.membranes.size(); ++i) {
    const size_t sides = c.model.membranes[i].sheet.triangles.size() * size_t(interactions::kSheetParts);
    std::uint8_t& near = c.state.sheet_near[t * c.model.membranes.size() + i];
    const tissue::Box& box = c.work.sheet_poses[i].bounds;
    double& gap = c.work.sheet_gaps[t * c.model.membranes.size() + i];
    gap = kNearSheet;
    if (near || interactions::meets_box(box, shape.part[interactions::kShaft].a, shape.frame.tip, kNearSheet))
      near = interactions::tool_on_sheet(touching, c.state.tools[t], interactions::kMembraneBase + int(i),
                                         c.work.sheets[i], {c.state.sheet_side.data() + at, sides},
                                         c.work.membrane_loads[i], gap);
    at += sides;
  }
}

// 5. Instruments on tissue: contact and hold.
void touch_tissue(StepContext& c) noexcept {
  const interactions::TissueView view = tissue_of(c);
  size_t at = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    const interactions::TouchBook& last = c.state.touches[t];
    interactions::ToolShape& before = c.work.shapes_before[t];
    before = interactions::shape_before(tool, last);
    interactions::Touching touching(tool.rubbing, before, shape, int(t), last, c.work.touches[t]);
    interactions::note_wall(c.work.wall_stops[t], touching);
    for (size_t i = 0; i < size_t(c.model.organs()); ++i)
      interactions::tool_on_surface(touching, interactions::kSolidBase + int(i), c.work.surfaces[i],
                                    c.work.organ_loads[i]);
    for (size_t i = 0; i < c.model.strands.size(); ++i) {
      const size_t sides = size_t(c.model.bodies[i].nodes() - 1) * size_t(interactions::kToolParts);
      interactions::tool_on_strand(tool, touching, c.state.tools[t], c.model.bodies[i], int(i), c.state.strands[i],
                                   {c.state.tool_side.data() + at, sides}, c.work.strand_loads[i]);
      at += sides;
    }
    touch_sheets(c, t, touching);
    interactions::hold_loads(shape, int(t), view, c.state.tools[t], c.work.strand_loads, c.work.organ_loads,
                             c.work.membrane_loads);
  }
}

// 6. Organs on organs.
void touch_organs(StepContext& c) noexcept {
  State& s = c.state;
  for (size_t i = 0; i < c.model.cuttables.size(); ++i) {
    const size_t organ = c.model.solids.size() + i;
    const tissue::CuttableWork& work = c.work.cuttable_work[i];
    const tissue::CuttableModel& body = c.model.cuttables[i].body;
    const geometry::CuttableTets& tets = s.cuttables[i].tets;
    if (work.parts > 1) piece_on_piece(c.work.surfaces[organ], work.part, work.largest_part, c.work.organ_loads[organ]);
    lip_on_lip(c.work.surfaces[organ], work.part, tets.source, body.own_nodes, tets.nodes, c.work.organ_loads[organ]);
  }
  size_t at = 0;
  for (const interactions::SurfacePair& p : c.model.surface_pairs) {
    const std::span<std::int32_t> nearest{s.nearest.data() + at, p.sample.size()};
    at += p.sample.size();
    const interactions::Surface& surface = c.work.surfaces[size_t(p.surface)];
    interactions::NetworkLoads* back = surface.moves() ? &c.work.organ_loads[size_t(p.surface)] : nullptr;
    if (p.strand >= 0) {
      const size_t i = size_t(p.strand);
      strand_on_surface(p, c.model.bodies[i], s.strands[i], surface, s.tick, nearest, c.work.strand_loads[i], back);
    } else if (p.membrane >= 0) {
      const size_t i = size_t(p.membrane);
      solid_on_surface(p, c.work.sheets[i].surface, surface, s.tick, nearest, c.work.membrane_loads[i], back);
    } else {
      const size_t i = size_t(p.solid);
      solid_on_surface(p, c.work.surfaces[i], surface, s.tick, nearest, c.work.organ_loads[i], back);
    }
  }
  size_t side = 0;
  for (const interactions::StrandPair& p : c.model.strand_pairs) {
    const size_t n = p.overlap.size(), a = size_t(p.a), b = size_t(p.b);
    strand_on_strand(p, c.model.bodies[a], s.strands[a], c.model.bodies[b], s.strands[b], {s.nearest.data() + at, n},
                     {s.strand_side.data() + side, n}, c.work.strand_loads[a], c.work.strand_loads[b]);
    at += n;
    side += n;
  }
  for (const interactions::SelfPair& p : c.model.self_pairs) {
    const size_t organ = size_t(p.organ), solids = c.model.solids.size();
    const tissue::CuttableWork* cut = organ < solids ? nullptr : &c.work.cuttable_work[organ - solids];
    const std::span<const std::int32_t> part = cut && cut->parts > 1 ? cut->part : std::span<const std::int32_t>{};
    self_contact(p, c.work.surfaces[organ], part, s.tick, {s.nearest.data() + at, p.sample.size()},
                 c.work.organ_loads[organ]);
    at += p.sample.size();
  }
}

/// Where a strand's end will be. `now` is first put where the host is: the end was placed by prediction last tick, and
/// taking that error for a velocity would feed it back with a gain of 1/dt.
tissue::StrandEnd end_of(const StepContext& c, const StrandEndModel& end, Vec3d drawn, Vec3d& now) noexcept {
  if (end.kind != StrandEndModel::hosted) return {drawn, {0, 0, 0}};
  const tissue::StrandEnd next = hosted_end(end.patch, c.work.nodes[size_t(end.organ)], kTick);
  now = next.x - kTick * next.v;
  return next;
}

// 7. Folds pull on what carries them.
void pull_on_borders(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept {
    tissue::border_pulls(c.model.membranes[i].sheet, c.state.membranes[i], c.work.membrane_work[i], c.work.pulls[i]);
  });
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    interactions::border_loads(c.model.membranes[i].holds, c.work.pulls[i], c.model.membranes[i].sheet,
                               c.state.membranes[i], holders_of(c), kTick, c.work.strand_loads, c.work.organ_loads);
}

// 8. Strands: implicit, ends where their hosts put them, pulling on them.
void advance_strands(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.strand_order, [&c](size_t i) noexcept {
    const StrandModel& strand = c.model.strands[i];
    const interactions::StrandBody& body = c.model.bodies[i];
    interactions::StrandLoads& loads = c.work.strand_loads[i];
    tissue::StrandState& state = c.state.strands[i];
    size_t ends = 0;
    if (strand.start.kind != StrandEndModel::free)
      c.work.ends[i][ends++] = end_of(c, strand.start, body.model.rest.front(), state.x.front());
    if (strand.end.kind != StrandEndModel::free)
      c.work.ends[i][ends++] = end_of(c, strand.end, body.model.rest.back(), state.x.back());
    loads.reaction.assign(loads.list.size(), Vec3d{});
    c.work.strand_reports[i] =
        tissue::advance(body.model, {c.work.ends[i].data(), ends}, loads.list, {c.work.end_reactions[i].data(), ends},
                        loads.reaction, state, c.work.strand_work[i]);
  });
  for (size_t i = 0; i < c.model.strands.size(); ++i) {
    const StrandModel& strand = c.model.strands[i];
    size_t ends = 0;
    for (const StrandEndModel* end : {&strand.start, &strand.end}) {
      if (end->kind == StrandEndModel::free) continue;
      const tissue::StrandReaction& reaction = c.work.end_reactions[i][ends++];
      if (end->kind != StrandEndModel::hosted) continue;
      const size_t host = size_t(end->organ);
      host_loads(end->patch, reaction, c.work.nodes[host], kTick, int(i), c.work.organ_loads[host]);
    }
  }
}

/// What a body has passed through of an instrument in this tick goes with it.
/// @param gap  how far apart they were at least, `each` numbers from hand to hand; 0 = unknown
void carry_along(const StepContext& c, int body, const interactions::Surface& surface,
                 std::span<const std::uint8_t> open, std::span<const std::uint8_t> fixed, double thickness,
                 const double* gap, size_t each, std::span<tissue::NodeState> rows) noexcept {
  constexpr double kThin = 0.0005;  // [m]
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    if (!interactions::meets_box(surface.pose->bounds, shape.part[interactions::kShaft].a, shape.frame.tip, kNearSheet))
      continue;
    const interactions::ToolState& tool = c.state.tools[t];
    std::array<std::int32_t, interactions::kMaxHolds> between;
    size_t held = 0;
    for (int h = 0; h < tool.holds; ++h)
      if (tool.hold[h].body == body) between[held++] = tool.hold[h].element;
    const interactions::Needles needles =
        interactions::needles_of(c.work.shapes_before[t], shape, std::max(kThin, thickness));
    interactions::carry_along(
        needles, {*surface.skin, *surface.pose, open, fixed, {between.data(), held}, surface.nodes.origin, rows},
        gap ? gap[t * each] : 0, kTick);
  }
}

// 9. Organs: explicit networks in their own sub-steps.
void advance_organs(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.organ_order, [&c](size_t i) noexcept {
    const size_t solids = c.model.solids.size(), k = i - solids;
    interactions::NetworkLoads& loads = c.work.organ_loads[i];
    loads.sort();
    const tissue::Hands hands = loads.handled() ? tissue::Hands::on : tissue::Hands::off;
    if (i < solids) {
      c.work.organ_reports[i] = tissue::advance(c.model.solids[i].network, loads.sorted, loads.reaction,
                                                c.state.solids[i], c.work.solid_work[i], nullptr, hands);
      return;
    }
    c.work.organ_reports[i] = tissue::advance(c.model.cuttables[k].body, loads.sorted, loads.reaction,
                                              c.state.cuttables[k], c.work.cuttable_work[k], hands);
    carry_along(c, interactions::kSolidBase + int(i), c.work.surfaces[i], {}, c.work.cuttable_work[k].fixed, 0, nullptr,
                0, c.state.cuttables[k].nodes);
  });
  view_organs(c);
}

// 10. Folds: borders go where their holders have gone.
void advance_membranes(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept {
    const MembraneModel& m = c.model.membranes[i];
    const interactions::Holders holders = holders_of(c);
    for (size_t h = 0; h < m.holds.size(); ++h) c.work.targets[i][h] = held_place(m.holds[h], holders);
    interactions::NetworkLoads& loads = c.work.membrane_loads[i];
    loads.sort();
    c.work.membrane_reports[i] = tissue::advance(m.sheet, c.work.targets[i], loads.sorted, loads.reaction,
                                                 c.state.membranes[i], c.work.membrane_work[i]);
    carry_along(c, interactions::kMembraneBase + int(i), c.work.sheets[i].surface, c.state.torn[i],
                m.sheet.network.fixed, m.sheet.thickness, c.work.sheet_gaps.data() + i, c.model.membranes.size(),
                c.state.membranes[i].network.nodes);
  });
}

void add_force(double (&sum)[3], Vec3d f) noexcept {
  sum[0] += f.x;
  sum[1] += f.y;
  sum[2] += f.z;
}

void account(StepContext& c, interactions::Tag tag, Vec3d force) noexcept {
  if (tag.owner == Owner::tool_contact) {
    add_force(c.state.tools[size_t(tag.index)].contact_force, -force);
    interactions::press_on(c.work.touches[size_t(tag.index)], tag.sub, force);
  }
  if (tag.owner != Owner::tool_hold) return;
  float(&on_tissue)[3] = c.state.tools[size_t(tag.index)].hold[tag.sub].force;
  on_tissue[0] += float(force.x);
  on_tissue[1] += float(force.y);
  on_tissue[2] += float(force.z);
}

// 11. What the tissue did to the instruments; slip.
void feel(StepContext& c) noexcept {
  for (interactions::ToolState& tool : c.state.tools) {
    for (double& f : tool.contact_force) f = 0;
    for (interactions::Hold& h : tool.hold) h.force[0] = h.force[1] = h.force[2] = 0;
  }
  for (const interactions::StrandLoads& l : c.work.strand_loads)
    for (size_t i = 0; i < l.list.size(); ++i) account(c, l.tag[i], l.reaction[i]);
  for (const interactions::NetworkLoads& l : c.work.organ_loads)
    for (size_t i = 0; i < l.sorted.size(); ++i) account(c, l.owner[i], vec_cast<double>(l.reaction[i]));
  for (const interactions::NetworkLoads& l : c.work.membrane_loads)
    for (size_t i = 0; i < l.sorted.size(); ++i) account(c, l.owner[i], vec_cast<double>(l.reaction[i]));
  const interactions::TissueView view = tissue_of(c);
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    interactions::ToolState& tool = c.state.tools[t];
    const interactions::WallStop& wall = c.work.wall_stops[t];
    if (wall.stopped) add_force(tool.contact_force, wall.force * wall.normal);
    const int held = tool.holds, slips = tool.slipped;
    interactions::slip(c.model.tool(c.state, t), c.work.shapes[t], view, tool);
    if (held > 0 && tool.holds == 0) tell_lost(c, t, slips);
    interactions::remember(tool, c.work.touches[t], c.state.touches[t]);
  }
}

// 13. Eyes: what the endoscope sees.
void see(StepContext& c) noexcept { look(c.model, c.state, c.work); }

// 14. Reports.
void sum_up(StepContext& c) noexcept {
  const auto take = [&c](const tissue::StepReport& r, int body) {
    c.report.flags |= r.flags;
    if (!r.fine() && c.report.first_bad_body < 0) {
      c.report.first_bad_body = body;
      c.report.first_bad_index = r.first_bad;
    }
  };
  const int organs = c.model.organs();
  for (int i = 0; i < organs; ++i) take(c.work.organ_reports[size_t(i)], i);
  for (size_t i = 0; i < c.model.strands.size(); ++i) take(c.work.strand_reports[i], organs + int(i));
  const int before = organs + int(c.model.strands.size());
  for (size_t i = 0; i < c.model.membranes.size(); ++i) take(c.work.membrane_reports[i], before + int(i));
  for (const interactions::TouchBook& book : c.state.touches)
    c.report.flags |= book.count == interactions::kMaxTouches ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.membrane_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.organ_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.strand_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  ++c.state.tick;
}

constexpr Stage kStages[] = {
    {"move hands", move_hands},
    {"pose skins", pose_skins},
    {"hang organs", hang_organs},
    {"work jaws", work_jaws},
    {"touch tissue", touch_tissue},
    {"touch organs", touch_organs},
    {"pull on borders", pull_on_borders},
    {"advance strands", advance_strands},
    {"advance organs", advance_organs},
    {"advance membranes", advance_membranes},
    {"feel", feel},
    {"tear", tear_tissue},
    {"see", see},
    {"sum up", sum_up},
};

}  // namespace

std::span<const Stage> stages() noexcept { return kStages; }

StepReport step(const Model& model, const Input& input, State& state, Work& work) noexcept {
  StepReport report;
  StepContext context{model, input, state, work, report};
  for (const Stage& stage : kStages) stage.run(context);
  return report;
}

}  // namespace trocar::sim
