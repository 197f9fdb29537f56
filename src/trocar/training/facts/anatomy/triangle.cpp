// How far a hepatocystic triangle is open: between a duct, the duct that it ends in, and what closes the third side.
// From the State, never from a picture.
#include <algorithm>
#include <cmath>

#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr double kUpstream = 0.028;  // [m] of the duct that the other ends in: common hepatic duct up to its fork [64]

struct Corners {
  Vec3d junction, neck, porta;
};

Vec3d place_on(const Snapshot& snapshot, std::size_t strand, double s) {
  const interactions::StrandBody& body = snapshot.model.strand_bodies[strand];
  return point_at(body, snapshot.state.strands[strand], interactions::place_at(body, s));
}

/// Arc length of the strand's node that is nearest to `p`, in the drawn shape.
double nearest_as_drawn(const interactions::StrandBody& body, Vec3d p) {
  const std::vector<Vec3d>& rest = body.model.rest;
  const auto nearer = [p](Vec3d a, Vec3d b) { return length(a - p) < length(b - p); };
  const auto nearest = std::min_element(rest.begin(), rest.end(), nearer);
  return body.arc[std::size_t(nearest - rest.begin())];
}

Corners corners(const Snapshot& snapshot, const Arguments& a) {
  const std::size_t of = std::size_t(a[0].index), on = std::size_t(a[1].index);
  const interactions::StrandBody &duct = snapshot.model.strand_bodies[of], &other = snapshot.model.strand_bodies[on];
  const double joins = nearest_as_drawn(other, duct.model.rest.front());
  return {place_on(snapshot, of, 0), place_on(snapshot, of, duct.length()),
          place_on(snapshot, on, std::max(0.0, joins - kUpstream))};
}

bool whole(const Snapshot& snapshot, const Arguments& a) {
  const std::vector<std::uint8_t>& alive = snapshot.state.strands[std::size_t(a[0].index)].alive;
  return std::all_of(alive.begin(), alive.end(), [](std::uint8_t element) { return element != 0; });
}

Value angle(const Snapshot& snapshot, const Arguments& a) {
  if (!whole(snapshot, a)) return kUnknown;
  const Corners c = corners(snapshot, a);
  const Vec3d duct = c.neck - c.junction, up = c.porta - c.junction;
  return portable::atan2(length(cross(duct, up)), dot(duct, up));
}

Value area(const Snapshot& snapshot, const Arguments& a) {
  if (!whole(snapshot, a)) return kUnknown;
  const Corners c = corners(snapshot, a);
  return 0.5 * length(cross(c.neck - c.junction, c.porta - c.junction));
}

std::vector<Parameter> two_ducts() {
  return {{"of", ArgumentKind::strand, "the cystic duct: from the junction to the neck of the gallbladder"},
          {"on", ArgumentKind::strand, "the duct that it joins, which begins at the liver"}};
}

}  // namespace

const Fact kTriangleAngle{"triangle.angle_deg",
                          two_ducts(),
                          0,
                          180,
                          "The hepatocystic angle: at the junction, between the straight lines to the cystic duct's "
                          "end and to a place 28 mm up the other duct. Unknown once the cystic duct is severed.",
                          anywhere,
                          &stateless<angle>};
const Fact kTriangleArea{"triangle.area_mm2",
                         two_ducts(),
                         0,
                         1e5,
                         "The area of the triangle between junction, the cystic duct's end and a place 28 mm up the "
                         "other duct. Unknown once the cystic duct is severed.",
                         anywhere,
                         &stateless<area>};

}  // namespace trocar::training
