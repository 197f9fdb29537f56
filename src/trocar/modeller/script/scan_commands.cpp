// Steps of a script that are about a patient's scan: read, segmented, seen, and made organs and vessels of.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>
#include <trocar/modeller/scan/segment_vessels.hpp>
#include <trocar/modeller/script/command_kinds.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/segment/brush.hpp>
#include <trocar/volumes/segment/islands.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>
#include <trocar/volumes/segment/threshold.hpp>
#include <trocar/volumes/show/caster.hpp>
#include <trocar/volumes/show/slice_image.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;

constexpr double kMostValue = 1e30;  // of a scan's voxels, as its readers keep them

scene::Key segment_key() {
  return scene::needed(keys::text("segment", "its name; made where a tool draws and there is none"));
}
std::vector<scene::Key> rule_keys(std::vector<scene::Key> list) {
  list.push_back(
      keys::number("only_from", -kMostValue, kMostValue, "only voxels of the scan with at least this value"));
  list.push_back(keys::number("only_to", -kMostValue, kMostValue, "and at most this"));
  list.push_back(keys::text("inside", "only voxels of this segment; \"none\": of no segment yet"));
  return list;
}

volumes::EditRules rules_of(const JsonObject& o, const Scan& scan) {
  volumes::EditRules rules;
  if (o.has("only_from") || o.has("only_to"))
    rules.values = {{o.number("only_from", -kMostValue), o.number("only_to", kMostValue)}};
  if (o.has("inside"))
    rules.inside = o.text("inside") == "none" ? std::uint16_t(0) : scan.segment_there(o.text("inside"));
  return rules;
}

/// Does a tool, and says what it made of the segment.
void edit(Session& session, const std::string& tool, std::uint16_t label, const volumes::LabelChange& change) {
  Scan& scan = session.scan();
  const double before = volumes::millilitres(scan.labels(), label);
  scan.change(tool, change);
  session.said().push_back({{"tool", tool},
                            {"segment", scan.labels().find(label) ? scan.labels().find(label)->name : ""},
                            {"before_mL", before},
                            {"mL", volumes::millilitres(scan.labels(), label)}});
}

volumes::Index3 voxel_at(const Scan& scan, Vec3d scene_mm) {
  return scan.volume().grid.nearest(volumes::patient_from_scene(scene_mm * 1e-3));
}

/// Which of several volumes of a file or folder.
std::vector<scene::Key> file_keys(const char* file) {
  return {
      scene::needed(keys::text("file", file)),
      keys::integer("series", 1, 10000,
                    "of several in a DICOM folder, as notes and faults list them; default: the file's own, or the one "
                    "with most slices"),
      keys::integer("frame", 0, 100000,
                    "of several time points, phases or layers, from 0; default: the file's own, or 0, the earliest")};
}
volumes::ReadOptions options_of(const JsonObject& o) {
  volumes::ReadOptions options;
  options.series = o.integer("series");
  if (o.has("frame")) options.frame = o.integer("frame");
  return options;
}

Command read_scan() {
  return {{"scan", "Reads a patient's scan: a folder of DICOM files or any file of a series, NIfTI, NRRD, MetaImage.",
           file_keys("its file or folder")},
          [](const JsonObject& o, Session& session) {
            session.put(Scan::open(o.text("file"), options_of(o)));
            const volumes::Volume& v = session.scan().volume();
            const volumes::Statistics all = volumes::statistics(v);
            session.said().push_back({{"scan", o.text("file")},
                                      {"format", session.scan().report().format},
                                      {"size", {v.grid.size[0], v.grid.size[1], v.grid.size[2]}},
                                      {"spacing_mm", {v.grid.spacing.x, v.grid.spacing.y, v.grid.spacing.z}},
                                      {"least", all.least},
                                      {"greatest", all.greatest},
                                      {"unit", v.unit},
                                      {"notes", session.scan().report().notes}});
          }};
}

/// Steps name segments: of two with one name they mean the first.
void tell_of_same_names(const volumes::Labels& labels, std::vector<std::string>& notes) {
  constexpr int kToldNames = 3;
  std::map<std::string, std::uint16_t> first;
  int told = 0;
  for (const volumes::Segment& s : labels.segments)
    if (const auto [known, is_new] = first.emplace(s.name, s.label); !is_new && told++ < kToldNames)
      notes.push_back(
          tr("labels {} and {} are both called \"{}\": steps mean the first. \"segment\": \"{}\" is the other",
             known->second, s.label, s.name, s.label));
}

Command read_label_map() {
  return {{"labels", "Reads a label map onto the scan's grid.", file_keys("its file")},
          [](const JsonObject& o, Session& session) {
            std::vector<std::string> notes = session.scan().take_labels(o.text("file"), options_of(o));
            tell_of_same_names(session.scan().labels(), notes);
            session.said().push_back({{"labels", session.scan().labels().segments.size()}, {"notes", notes}});
          }};
}

Command write_label_map() {
  return {
      {"write_labels", "Writes the label map: .nrrd, .nii, .nii.gz.", {scene::needed(keys::text("file", "its file"))}},
      [](const JsonObject& o, Session& session) { volumes::write_labels(o.text("file"), session.scan().labels()); }};
}

Command name_segment() {
  return {{"name_segment",
           "Gives a segment another name.",
           {segment_key(), scene::needed(keys::text("to", "the new one"))}},
          [](const JsonObject& o, Session& session) {
            session.scan().rename(session.scan().segment_there(o.text("segment")), o.text("to"));
          }};
}

Command threshold() {
  return {{"threshold", "All voxels between two values.",
           rule_keys({segment_key(), scene::needed(keys::number("from", -kMostValue, kMostValue, "least value")),
                      scene::needed(keys::number("to", -kMostValue, kMostValue, "greatest value"))})},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment(o.text("segment"));
            edit(session, "threshold", label,
                 volumes::thresholded(scan.volume(), scan.labels(), {o.number("from"), o.number("to")}, label,
                                      rules_of(o, scan)));
          }};
}

Command grow() {
  return {{"grow", "From seeds to all that hangs together between two values.",
           rule_keys({segment_key(),
                      scene::needed(keys::points("seeds_mm", -10000, 10000, 1, "places, as scenes have them")),
                      scene::needed(keys::number("from", -kMostValue, kMostValue, "least value")),
                      scene::needed(keys::number("to", -kMostValue, kMostValue, "greatest value"))})},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment(o.text("segment"));
            std::vector<volumes::Index3> seeds;
            for (const Vec3d& p : o.points("seeds_mm")) seeds.push_back(voxel_at(scan, p));
            edit(session, "grow", label,
                 volumes::grown(scan.volume(), scan.labels(), seeds, {o.number("from"), o.number("to")}, label,
                                rules_of(o, scan)));
          }};
}

Command grow_all() {
  return {
      {"grow_all", "All segments are seeds and grow until they meet at the scan's edges.",
       rule_keys({keys::number("margin_mm", 0, 500, "how far, default 50"),
                  keys::number("contrast", 1, 10000, "what difference of values counts as two steps, default 20")})},
      [](const JsonObject& o, Session& session) {
        Scan& scan = session.scan();
        volumes::CompeteOptions options;
        options.margin_mm = o.number("margin_mm", options.margin_mm);
        options.contrast = o.number("contrast", options.contrast);
        edit(session, "grow_all", 0,
             volumes::grown_from_labels(scan.volume(), scan.labels(), options, rules_of(o, scan)));
      }};
}

Command paint() {
  return {
      {"paint", "A ball along a stroke gets the segment; \"erase\" takes it away.",
       rule_keys(
           {segment_key(), scene::needed(keys::points("stroke_mm", -10000, 10000, 1, "places, as scenes have them")),
            keys::number("radius_mm", 0.1, 200, "of the ball, default 5"), keys::flag("erase", "default false")})},
      [](const JsonObject& o, Session& session) {
        Scan& scan = session.scan();
        const bool erases = o.flag("erase");
        const std::uint16_t label = scan.segment(o.text("segment"));
        std::vector<Vec3d> stroke;
        for (const Vec3d& p : o.points("stroke_mm")) stroke.push_back(volumes::patient_from_scene(p * 1e-3));
        volumes::EditRules rules = rules_of(o, scan);
        if (erases && !rules.inside) rules.inside = label;
        volumes::Brush brush;
        brush.radius_mm = o.number("radius_mm", 5);
        edit(session, erases ? "erase" : "paint", label,
             volumes::painted(scan.volume(), scan.labels(), stroke, brush, erases ? std::uint16_t(0) : label, rules));
      }};
}

Command islands() {
  return {{"islands",
           "Of the parts of a segment the largest stays, or the one at a place, or those that are large enough.",
           {segment_key(), keys::vec3("at_mm", -10000, 10000, "the part there stays"),
            keys::number("least_mL", 0, 100000, "parts of at least so much stay")}},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment_there(o.text("segment"));
            const double voxel = scan.volume().grid.voxel_ml();
            edit(session, "islands", label,
                 o.has("at_mm")
                     ? volumes::chosen_kept(scan.volume(), scan.labels(), label, voxel_at(scan, o.vec3("at_mm")))
                 : o.has("least_mL") ? volumes::small_removed(scan.volume(), scan.labels(), label,
                                                              std::size_t(std::ceil(o.number("least_mL") / voxel)))
                                     : volumes::largest_kept(scan.volume(), scan.labels(), label));
          }};
}

Command fill_holes() {
  return {{"fill_holes", "What a segment encloses gets it.", {segment_key()}},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment_there(o.text("segment"));
            edit(session, "fill_holes", label, volumes::holes_filled(scan.volume(), scan.labels(), label));
          }};
}

Command margin() {
  return {{"margin", "Grows a segment by so much all around, or shrinks it.",
           rule_keys({segment_key(), scene::needed(keys::number("by_mm", -100, 100, "how much"))})},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment_there(o.text("segment"));
            edit(session, "margin", label,
                 volumes::margin_moved(scan.volume(), scan.labels(), label, o.number("by_mm"), rules_of(o, scan)));
          }};
}

Command smooth() {
  return {
      {"smooth", "Smoothes a segment and keeps its volume.",
       rule_keys({segment_key(), keys::number("radius_mm", 0.1, 50, "of what counts as around, default 3"),
                  keys::flag("median", "thin parts go and convex ones shrink instead; default false")})},
      [](const JsonObject& o, Session& session) {
        Scan& scan = session.scan();
        const std::uint16_t label = scan.segment_there(o.text("segment"));
        const volumes::Smoothing how = o.flag("median") ? volumes::Smoothing::median : volumes::Smoothing::keeps_volume;
        edit(session, "smooth", label,
             volumes::smoothed(scan.volume(), scan.labels(), label, o.number("radius_mm", 3), how, rules_of(o, scan))
                 .change);
      }};
}

Command between_slices() {
  return {{"between_slices", "Fills the gaps between slices in which a segment was drawn.",
           rule_keys({segment_key(), keys::integer("axis", 0, 2, "across which the slices are, default 2")})},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment_there(o.text("segment"));
            edit(session, "between_slices", label,
                 volumes::filled_between_slices(scan.volume(), scan.labels(), label, o.integer("axis", 2),
                                                rules_of(o, scan)));
          }};
}

Command combine() {
  return {{"combine",
           "Logic of two segments: the first becomes the other, both, itself without it, or what both are.",
           {segment_key(),
            scene::needed(keys::choice("how", {"copy", "add", "subtract", "intersect", "invert", "clear"}, "")),
            keys::text("with", "the other one; not for invert and clear")}},
          [](const JsonObject& o, Session& session) {
            Scan& scan = session.scan();
            const std::uint16_t label = scan.segment(o.text("segment"));
            static const std::vector<std::pair<std::string, volumes::Logic>> words{
                {"copy", volumes::Logic::copy},         {"add", volumes::Logic::add},
                {"subtract", volumes::Logic::subtract}, {"intersect", volumes::Logic::intersect},
                {"invert", volumes::Logic::invert},     {"clear", volumes::Logic::clear}};
            volumes::Logic how = volumes::Logic::copy;
            for (const auto& [word, meant] : words)
              if (word == o.text("how")) how = meant;
            const std::uint16_t other = o.has("with") ? scan.segment_there(o.text("with")) : label;
            edit(session, "combine", label,
                 volumes::combined(scan.volume(), scan.labels(), label, how, volumes::voxels_of(scan.labels(), other)));
          }};
}

Command measure() {
  return {{"measure",
           "Reports a segment's volume and the scan's values in it.",
           {segment_key(), keys::number("mean_from", -kMostValue, kMostValue, "a mean below this is a fault"),
            keys::number("mean_to", -kMostValue, kMostValue, "one above, too")}},
          [](const JsonObject& o, Session& session) {
            const Scan& scan = session.scan();
            const std::uint16_t label = scan.segment_there(o.text("segment"));
            const volumes::Statistics s = volumes::statistics(scan.volume(), scan.labels(), label);
            session.said().push_back({{"segment", o.text("segment")},
                                      {"mL", volumes::millilitres(scan.labels(), label)},
                                      {"mean", s.mean},
                                      {"deviation", s.deviation}});
            if (s.mean < o.number("mean_from", -kMostValue) || s.mean > o.number("mean_to", kMostValue))
              o.fault("segment", tr("expected a mean value from {:g} to {:g}, got {:.1f}", o.number("mean_from"),
                                    o.number("mean_to"), s.mean));
          }};
}

Command undo_tool() {
  return {{"undo_tool", "Takes the last change of segments back.", {}}, [](const JsonObject& o, Session& session) {
            if (!session.scan().undo()) o.fault(o.at(), "expected a change of segments to take back, got none");
          }};
}

render::Image image_of(const volumes::Picture& p) {
  render::Image image{p.width, p.height, std::vector<std::uint8_t>(std::size_t(3 * p.width * p.height))};
  for (std::size_t i = 0; i < std::size_t(p.width * p.height); ++i)
    std::copy_n(p.rgba.begin() + std::ptrdiff_t(4 * i), 3, image.rgb.begin() + std::ptrdiff_t(3 * i));
  return image;
}

Vec3d middle_of_scan(const Scan& scan) {
  const geometry::Bounds box = volumes::patient_box(scan.volume().grid);
  return (box.low + box.high) / 2.0;
}

Command slice() {
  return {{"slice",
           "Draws a slice of the scan with its segments.",
           {scene::needed(keys::name("name", "of the picture")),
            keys::choice("plane", {"axial", "coronal", "sagittal"}, "default axial"),
            keys::vec3("at_mm", -10000, 10000, "a place in it, as scenes have it; default: the middle"),
            keys::number("centre", -kMostValue, kMostValue, "of the window, default 40"),
            keys::number("width", 1, 200000, "of the window, default 400"), keys::flag("labels", "default true")}},
          [](const JsonObject& o, Session& session) {
            if (!session.draws()) return;
            const Scan& scan = session.scan();
            const Vec3d at =
                o.has("at_mm") ? volumes::patient_from_scene(o.vec3("at_mm") * 1e-3) : middle_of_scan(scan);
            const volumes::Grid& grid = scan.volume().grid;
            const std::string plane = o.text("plane", "axial");
            const volumes::SlicePlane cut = plane == "coronal"    ? volumes::coronal(grid, at)
                                            : plane == "sagittal" ? volumes::sagittal(grid, at)
                                                                  : volumes::axial(grid, at);
            volumes::SliceLook look;
            look.centre = o.number("centre", look.centre);
            look.width = o.number("width", look.width);
            session.keep_picture(o.text("name"),
                                 image_of(volumes::slice_image(
                                     scan.volume(), o.flag("labels", true) ? &scan.labels() : nullptr, cut, look)));
          }};
}

Command block() {
  return {{"block",
           "Draws the scan as a block.",
           {scene::needed(keys::name("name", "of the picture")),
            keys::choice("look", {"bone", "skin", "vessels", "soft_tissue"}, "default soft_tissue"),
            keys::number("yaw_deg", -360, 360, "from where: 0 from the feet, 90 from the patient's left; default 20"),
            keys::number("pitch_deg", -88, 88, "above the patient's plane, default 30"),
            keys::number("fine", 0.1, 4, "samples a voxel, default 1"),
            keys::flag("labels", "tinted by segments; default true")}},
          [](const JsonObject& o, Session& session) {
            if (!session.draws()) return;
            const Scan& scan = session.scan();
            core::ThreadPool pool(core::default_thread_count());
            volumes::VolumeCaster caster(scan.volume(), pool);
            static const std::vector<std::pair<std::string, volumes::TransferPreset>> looks{
                {"bone", volumes::TransferPreset::bone},
                {"skin", volumes::TransferPreset::skin},
                {"vessels", volumes::TransferPreset::vessels},
                {"soft_tissue", volumes::TransferPreset::soft_tissue}};
            volumes::TransferPreset preset = volumes::TransferPreset::soft_tissue;
            for (const auto& [word, meant] : looks)
              if (word == o.text("look")) preset = meant;
            caster.set_transfer(volumes::transfer_preset(preset));
            if (o.flag("labels", true) && !scan.labels().segments.empty()) caster.set_labels(&scan.labels());
            const geometry::Bounds box = volumes::patient_box(scan.volume().grid);
            view::Orbit orbit;
            orbit.target = volumes::scene_from_patient((box.low + box.high) / 2.0);
            orbit.distance = 1e-3 * 1.6 * length(box.high - box.low);
            orbit.yaw = o.number("yaw_deg", 20) * portable::pi / 180;
            orbit.pitch = o.number("pitch_deg", 30) * portable::pi / 180;
            volumes::View view;
            view.eye = orbit.eye();
            view.target = orbit.target;
            view.up = {0, 0, 1};
            volumes::Quality quality;
            quality.step = 1 / o.number("fine", 1);
            const volumes::Rendered r = caster.render(view, quality);
            session.said().push_back({{"block", o.text("name")}, {"ms", r.milliseconds}});
            session.keep_picture(o.text("name"), image_of(r.picture));
          }};
}

Command organ() {
  return {
      {"organ_from",
       "Makes a solid of a segment: its smooth surface goes into a file beside the document.",
       {segment_key(), scene::needed(keys::name("name", "of the organ")),
        scene::needed(keys::name("tissue", "its material")),
        keys::number("cell_mm", 0.5, 50, "edge of its cells; default: about 700 of them"),
        keys::flag("cuttable", "can it be cut? default false"),
        keys::vec3("centre_mm", -2000, 2000, "where its middle goes; default: where it is in the scan"),
        keys::name("look", "its surface in the picture"),
        keys::integer("triangles", 100, 400000, "of the surface at most, default 20000"),
        keys::number("within", 0, 1, "how much its volume may differ from the segment's, as a share; default 0.02")}},
      [](const JsonObject& o, Session& session) {
        OrganWish wish{o.text("segment"),       o.text("name"),     o.text("tissue"), o.text("look"),
                       o.number("cell_mm"),     o.flag("cuttable"), std::nullopt,     o.integer("triangles", 20000),
                       o.number("within", 0.02)};
        if (o.has("centre_mm")) wish.centre_mm = o.vec3("centre_mm");
        const SegmentOrgan made = make_organ(session.document(), session.scan(), wish);
        const auto list = [](Vec3d v) { return Json{v.x, v.y, v.z}; };
        session.said().push_back({{"organ", wish.name},
                                  {"mL_of_segment", made.segment_mL},
                                  {"mL", made.mL},
                                  {"triangles", made.triangles},
                                  {"middle_mm", list(made.middle_mm)},
                                  {"size_mm", list(made.size_mm)}});
      }};
}

Command vessels() {
  return {
      {"vessels_from",
       "Makes a tree of vessels of a segment: centre lines from branching to branching, radii as the scan shows them.",
       {segment_key(), scene::needed(keys::text("file", "the file of vessels, relative to the document, new")),
        scene::needed(keys::name("name", "of the tree, and before its vessels' numbers")),
        keys::vec3("root_mm", -10000, 10000, "where blood comes from; default: the thicker of the two far ends"),
        keys::vec3("move_mm", -10000, 10000, "by how much it lies elsewhere than in the scan, default 0"),
        keys::number("flow_mL_min", 0.01, 20000, "of the whole tree, default 100"),
        keys::number("least_branch_mm", 1, 200, "shorter ones are bumps of the wall, default 8")}},
      [](const JsonObject& o, Session& session) {
        VesselWish wish;
        wish.segment = o.text("segment");
        wish.file = o.text("file");
        wish.name = o.text("name");
        if (o.has("root_mm")) wish.root_mm = o.vec3("root_mm");
        if (o.has("move_mm")) wish.move_mm = o.vec3("move_mm");
        wish.flow_mL_min = o.number("flow_mL_min", wish.flow_mL_min);
        wish.least_branch_mm = o.number("least_branch_mm", wish.least_branch_mm);
        session.said().push_back({{"vessels", make_vessels(session.document(), session.scan(), wish)}});
      }};
}

}  // namespace

std::vector<Command> scan_commands() {
  return {read_scan(), read_label_map(), write_label_map(), name_segment(), threshold(), grow(),           grow_all(),
          paint(),     islands(),        fill_holes(),      margin(),       smooth(),    between_slices(), combine(),
          measure(),   undo_tool(),      slice(),           block(),        organ(),     vessels()};
}

}  // namespace trocar::modeller
