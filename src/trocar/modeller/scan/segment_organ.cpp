#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/drive/readiness.hpp>
#include <trocar/modeller/operations/beside.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>
#include <trocar/volumes/organ/label_surface.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

[[noreturn]] void refuse_organ(const fs::path& file, std::string message) {
  throw core::BadInput({{{file.generic_string(), 0, 0}, std::move(message)}});
}

volumes::LabelSurface surface_of_segment(const Scan& scan, const OrganWish& wish) {
  volumes::SurfaceOptions options;
  options.most_triangles = wish.most_triangles;
  volumes::LabelSurface made = volumes::label_surface(scan.labels(), scan.segment_there(wish.segment), options);
  if (!made.is_body)
    refuse_organ(scan.path(),
                 "expected a segment whose surface is a closed body, got one that is not: smooth it, or keep "
                 "its largest part");
  if (std::fabs(made.ml / made.ml_of_label - 1) > wish.within)
    refuse_organ(scan.path(),
                 tr("expected a surface of the segment's {:.2f} mL, got {:.2f}", made.ml_of_label, made.ml));
  return made;
}

/// A ball in the middle of a mesh [m] that is moved [mm].
JsonValue attachment(const geometry::TriMesh& mesh, Vec3d by_mm, double cell_mm) {
  const scene::Anchor hold = hold_in_middle(mesh, 1e-3 * cell_mm);
  JsonValue ball = scene::json_object();
  scene::put(ball, "centre_mm", point(hold.centre * 1e3 + by_mm));
  scene::put(ball, "radius_mm", number(hold.radius * 1e3));
  return ball;
}

}  // namespace

SegmentOrgan make_organ(Document& document, const Scan& scan, const OrganWish& wish) {
  if (const auto counts = volumes::voxels_per_label(scan.labels()); counts[scan.segment_there(wish.segment)] == 0)
    refuse_organ(scan.path(), tr("The segment \"{}\" is empty. Paint, threshold or grow it first.", wish.segment));
  const volumes::LabelSurface made = surface_of_segment(scan, wish);
  const geometry::Bounds box = geometry::bounds(made.mesh.positions);
  const SegmentOrgan out{made.ml_of_label, made.ml, made.mesh.triangles.size(), (box.low + box.high) / 2.0 * 1e3,
                         (box.high - box.low) * 1e3};
  JsonValue solid = scene::json_object();
  const Vec3d centre = wish.centre_mm ? *wish.centre_mm : wish.place_mm ? wish.place_mm(out.size_mm) : out.middle_mm;
  const double cell = wish.cell_mm > 0 ? wish.cell_mm : std::round(10 * std::cbrt(made.ml * 1e3 / 700)) / 10;
  scene::put(solid, "name", scene::json_text(wish.name));
  scene::put(solid, "tissue", scene::json_text(wish.tissue));
  if (!wish.look.empty()) scene::put(solid, "look", scene::json_text(wish.look));
  Draft trial(document);
  add_thing(trial, "solid", solid, "");  // refuses a name that is taken before anything is written
  scene::put(solid, "surface", surface_beside(document, wish.name, made.mesh, centre));
  scene::put(solid, "cell_mm", number(cell));
  if (wish.attach)
    scene::put(solid, "anchors", scene::json_array({attachment(made.mesh, centre - out.middle_mm, cell)}));
  if (wish.cuttable) scene::put(solid, "cuttable", scene::json_flag(true));
  Draft draft(document);
  add_thing(draft, "solid", solid, "");
  commit(document, "organ from " + wish.segment, draft);
  return out;
}

}  // namespace trocar::modeller
