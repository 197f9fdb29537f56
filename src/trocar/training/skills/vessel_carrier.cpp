#include <trocar/training/skills/vessel_carrier.hpp>

namespace trocar::training {
namespace {

VesselCarrier on_strand(Surgeon& op, int strand, interactions::StrandPlace place) {
  const interactions::StrandBody& body = op.model().strand_bodies[size_t(strand)];
  const tissue::StrandState& state = op.state().strands[size_t(strand)];
  return {interactions::point_at(body, state, place), interactions::tangent_at(body, state, place),
          body.model.radius[size_t(place.element)]};
}

}  // namespace

VesselCarrier carrier_at(Surgeon& op, int vessel, double s) {
  const interactions::VesselSpot at = op.vessel_spot(vessel, s);
  const interactions::VesselPoint& point = op.model().vessels.list[size_t(vessel)].path.points[size_t(at.after)];
  if (!point.rides.body.is(BodyKind::strand)) return {at.place, at.along, point.radius};
  const int strand = int(point.rides.body.index());
  const interactions::StrandPlace on = place_on_rod(point.rides);
  // The point before the place: what is left lies along the strand.
  const interactions::StrandBody& body = op.model().strand_bodies[size_t(strand)];
  const VesselCarrier before = on_strand(op, strand, on);
  const double ahead = dot(at.place - before.place, before.along);
  return on_strand(op, strand, interactions::place_at(body, interactions::arc_at(body, on) + ahead));
}

}  // namespace trocar::training
