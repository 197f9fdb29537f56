// Steps of a script that are about the session: documents, builds, test drives, pictures.
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/modeller/drive/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/script/command_kinds.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;

constexpr double kDegree = portable::pi / 180;

/// A file that is there is written over only where the step says so; else that is a fault of the key that names it.
bool may_write(const JsonObject& o, const char* key, const fs::path& file) {
  std::error_code error;
  if (o.flag("over") || !fs::exists(fs::symlink_status(file, error))) return true;
  o.fault(key, tr("expected the name of a new file, got \"{}\", which exists: \"over\": true replaces it",
                  file.generic_string()));
  return false;
}

scene::Key over_key() { return keys::flag("over", "a file that exists is replaced; default false"); }

Command open() {
  return {{"open", "Opens a scene or an organ.", {scene::needed(keys::text("file", "its file"))}},
          [](const JsonObject& o, Session& session) { session.put(Document::open(o.text("file"))); }};
}

Command begin() {
  return {{"new",
           "Begins a scene in the modelling place, or an organ alone.",
           {scene::needed(keys::text("file", "the file that it is saved to")),
            keys::choice("kind", {"scene", "organ"}, "default scene"), keys::name("name", "default: the file's")}},
          [](const JsonObject& o, Session& session) {
            const fs::path file = whole_path(o.text("file"));
            std::error_code error;
            if (fs::exists(file, error))
              return o.fault("file",
                             tr("expected a new file, got {}, which is there: open it instead", file.generic_string()));
            session.put(begun(file, o.text("kind") == "organ", o.text("name", file.stem().string())));
          }};
}

Command save() {
  return {
      {"save", "Writes what has changed.", {keys::text("as", "another file, default: the one that it is"), over_key()}},
      [](const JsonObject& o, Session& session) {
        Document& document = session.document();
        const fs::path file = o.has("as") ? whole_path(o.text("as")) : document.root();
        if (file == document.root())
          document.save(o.flag("over"));
        else if (may_write(o, "as", file))
          document.save_as(file);
      }};
}

Command undo() {
  return {{"undo", "Takes changes back.", {keys::integer("times", 1, 100000, "default 1")}},
          [](const JsonObject& o, Session& session) {
            for (int i = 0; i < o.integer("times", 1); ++i)
              if (!session.document().undo()) return o.fault(o.at(), "expected a change to take back, got none");
          }};
}

Command redo() {
  return {{"redo", "Makes changes again that were taken back.", {keys::integer("times", 1, 100000, "default 1")}},
          [](const JsonObject& o, Session& session) {
            for (int i = 0; i < o.integer("times", 1); ++i)
              if (!session.document().redo()) return o.fault(o.at(), "expected a change that was taken back, got none");
          }};
}

Command check() {
  return {{"check",
           "Compiles the document and reports volume, mass, load and equilibrium.",
           {keys::number("seconds", 0, 10, "simulated to see whether it is in equilibrium, default 1"),
            keys::flag("still", "a body that sags is a fault; default false")}},
          [](const JsonObject& o, Session& session) {
            session.model();
            Json bodies = Json::array();
            for (const ReadOut& r : read_outs(session.built(), std::uint64_t(1000 * o.number("seconds", 1)))) {
              bodies.push_back({{"name", r.name},
                                {"kind", r.kind},
                                {"nodes", r.nodes},
                                {"springs", r.springs},
                                {"substeps", r.substeps},
                                {"volume_mL", r.volume_mL},
                                {"mass_g", r.mass_g},
                                {"predicted_us", r.predicted_us},
                                {"memory_kB", std::round(1e-3 * double(r.bytes))}});
              if (r.off_mm >= 0) bodies.back()["off_mm"] = r.off_mm;
              if (o.flag("still") && r.off_mm > 0.5)
                o.fault(o.at(), tr("{} is not in equilibrium: it sagged {:.1f} mm in {:g} s", r.name, r.off_mm,
                                   o.number("seconds", 1)));
            }
            for (const std::string& note : session.built().notes) {
              if (o.flag("still")) o.fault(o.at(), note);
              session.said().push_back({{"note", note}});
            }
            session.said().push_back({{"check", bodies}});
          }};
}

Command take() {
  return {{"take",
           "A grasper takes hold of what is nearest to a place.",
           {scene::needed(keys::vec3("at_mm", -2000, 2000, "where")), keys::name("of", "of this body only")}},
          [](const JsonObject& o, Session& session) {
            TestDrive& drive = session.drive();
            if (drive.hand() < 0) return o.fault(o.at(), "expected a scene with a grasper in a hand, got none");
            std::vector<BodyPlace> places;
            for (const BodyPlace& p : places_of(session.model(), drive.state()))
              if (!o.has("of") || sim::name_of(session.model(), p.body) == o.text("of")) places.push_back(p);
            const std::optional<BodyPlace> there = nearest(places, o.vec3("at_mm") * 1e-3);
            if (!there) return o.fault(o.at(), "expected a body to take hold of, got none");
            drive.take(there->at);
            for (int i = 0; i < 20000 && !drive.done(); ++i) drive.tick();
            session.said().push_back({{"take", sim::name_of(session.model(), there->body)}, {"holds", drive.holds()}});
            if (!drive.holds()) o.fault(o.at(), "expected the grasper to take hold, got empty jaws");
          }};
}

/// With what blood has left vessels.
Json with_blood(Json said, const TestDrive& drive) {
  said["blood_lost_mL"] = 1e6 * drive.blood_lost();
  return said;
}

/// A place along a vessel as its file draws it [m].
Vec3d on_vessel(const Document& document, const std::string& name, double share) {
  const Thing thing = thing_named(document, "vessel:" + name);
  const scene::JsonValue value = value_of(document, thing);
  const scene::JsonMember* path = value.find("path_mm");
  const std::vector<Vec3d> points = path ? points_of(path->value) : std::vector<Vec3d>{};
  if (points.empty()) return {};
  const double at = share * double(points.size() - 1);
  const std::size_t i = std::min(std::size_t(at), points.size() - 1), next = std::min(i + 1, points.size() - 1);
  return (points[i] + (points[next] - points[i]) * (at - double(i))) * 1e-3;
}

Command use() {
  return {
      {"use",
       "An instrument goes to a place and closes there, then opens: scissors cut, a clip applier clips.",
       {scene::needed(keys::text("instrument", "its name")), keys::vec3("at_mm", -2000, 2000, "where its jaws close"),
        keys::text("vessel", "or on this vessel"), keys::number("share", 0, 1, "how far along it, default 0.5")}},
      [](const JsonObject& o, Session& session) {
        if (o.has("at_mm") == o.has("vessel")) return o.fault(o.at(), "expected either \"at_mm\" or \"vessel\"");
        TestDrive& drive = session.drive();
        const Vec3d at = o.has("at_mm") ? o.vec3("at_mm") * 1e-3
                                        : on_vessel(session.document(), o.text("vessel"), o.number("share", 0.5));
        if (!drive.choose(o.text("instrument")))
          return o.fault("instrument", "expected an instrument that a hand has or can take, got none of this name");
        for (int i = 0; i < 20000 && !drive.done(); ++i) drive.tick();
        const sim::State& state = drive.state();
        const int strand_clips = state.clip_count, vessel_clips = state.vessel_clip_count;
        const int strand_cuts = state.cut_count, openings = state.opening_count;
        std::vector<std::uint64_t> shapes;  // another one of an organ that was cut
        for (const tissue::CuttableState& organ : state.cuttables) shapes.push_back(organ.version);
        drive.take(at);
        for (int i = 0; i < 20000 && !drive.done(); ++i) drive.tick();
        drive.let_go();
        for (int i = 0; i < 5000 && !drive.done(); ++i) drive.tick();
        Json clipped = Json::array(), cut = Json::array();  // names of vessels, strands, organs
        const sim::Model& model = session.model();
        for (int i = strand_clips; i < state.clip_count; ++i)
          if (const int strand = state.clips[std::size_t(i)].strand; strand >= 0)
            clipped.push_back(model.strands[std::size_t(strand)].name);
          else if (const BodyId body = state.clips[std::size_t(i)].body(); body.exists())
            clipped.push_back(sim::name_of(model, body));
        for (int i = vessel_clips; i < state.vessel_clip_count; ++i)
          clipped.push_back(tr("{}, {:.0f} % of its width",
                               model.vessels.list[std::size_t(state.vessel_clips[std::size_t(i)].vessel)].name,
                               100 * state.vessel_clips[std::size_t(i)].cover));
        for (int i = strand_cuts; i < state.cut_count; ++i)
          if (const int strand = state.cuts[std::size_t(i)].strand; strand >= 0)
            cut.push_back(model.strands[std::size_t(strand)].name);
        for (int i = openings; i < state.opening_count; ++i)
          cut.push_back(model.vessels.list[std::size_t(state.openings[std::size_t(i)].vessel)].name);
        for (std::size_t i = 0; i < shapes.size(); ++i)
          if (state.cuttables[i].version != shapes[i]) cut.push_back(model.cuttables[i].name);
        session.said().push_back(
            with_blood({{"use", o.text("instrument")}, {"clipped", clipped}, {"cut", cut}}, drive));
      }};
}

Command pull() {
  return {{"pull",
           "Draws what the grasper holds.",
           {scene::needed(keys::vec3("by_mm", -500, 500, "how far")),
            keys::number("seconds", 0, 60, "that it is held there, default 0.5")}},
          [](const JsonObject& o, Session& session) {
            TestDrive& drive = session.drive();
            const Vec3d from = drive.tip();
            drive.pull_to(from + o.vec3("by_mm") * 1e-3);
            for (int i = 0; i < 60000 && !drive.done(); ++i) drive.tick();
            for (int i = 0; i < int(1000 * o.number("seconds", 0.5)); ++i) drive.tick();
            session.said().push_back(
                {{"pull_N", drive.pull()}, {"holds", drive.holds()}, {"moved_mm", 1e3 * length(drive.tip() - from)}});
          }};
}

Command let_go() {
  return {{"let_go", "The grasper opens and draws back.", {}}, [](const JsonObject&, Session& session) {
            TestDrive& drive = session.drive();
            drive.let_go();
            for (int i = 0; i < 5000 && !drive.done(); ++i) drive.tick();
          }};
}

Command rest() {
  return {{"rest", "Nobody touches anything for a while.", {scene::needed(keys::number("seconds", 0, 60, "how long"))}},
          [](const JsonObject& o, Session& session) {
            TestDrive& drive = session.drive();
            const double before = drive.blood_lost();
            const int ticks = int(1000 * o.number("seconds"));
            for (int i = 0; i < ticks; ++i) drive.tick();
            const double lost = drive.blood_lost() - before;
            session.said().push_back(with_blood(
                {{"rest_s", o.number("seconds")}, {"bleeds_mL_min", 1e6 * lost / std::max(1e-3, 1e-3 * ticks) * 60}},
                drive));
          }};
}

Command stop() {
  return {{"stop", "Ends the test drive: all bodies return to their shape in the file.", {}},
          [](const JsonObject&, Session& session) { session.stop_driving(); }};
}

Command shot() {
  return {
      {"shot",
       "Draws a picture.",
       {scene::needed(keys::name("name", "of the picture")), keys::text("points", "the thing whose points are shown"),
        keys::name("of", "the body that fills the picture, default: all"),
        keys::number("yaw_deg", -360, 360, "from where: 0 from the feet, 90 from the patient's left; default 20"),
        keys::number("pitch_deg", -88, 88, "above the patient's plane, default 30"),
        keys::number("distance_mm", 0, 1500, "from the middle, default: so that all is in it"),
        keys::flag("scope", "through the scene's endoscope; default false")}},
      [](const JsonObject& o, Session& session) {
        session.shot(o.text("name"), o.text("points"), o.text("of"), o.number("yaw_deg", 20) * kDegree,
                     o.number("pitch_deg", 30) * kDegree, o.number("distance_mm") * 1e-3, o.flag("scope"));
      }};
}

Command export_body() {
  return {
      {"export",
       "Writes a body, a vessel or a wall as compiled: its skin as .obj, .stl, .ply or .vtk, its network with springs "
       "and cells as .msh.",
       {scene::needed(keys::name("of", "the body")), scene::needed(keys::text("file", "the file; its end says what")),
        over_key()}},
      [](const JsonObject& o, Session& session) {
        const fs::path file = o.text("file");
        if (!may_write(o, "file", file)) return;
        core::put_file(file, exported(session.model(), o.text("of"), file.extension().string()));
      }};
}

}  // namespace

std::vector<Command> session_commands() {
  return {export_body(), open(), begin(), save(),   undo(), redo(), check(),
          take(),        use(),  pull(),  let_go(), rest(), stop(), shot()};
}

const std::vector<Command>& commands() {
  static const std::vector<Command> all = [] {
    std::vector<Command> list = session_commands();
    for (Command& command : scan_commands()) list.push_back(std::move(command));
    return list;
  }();
  return all;
}

const Command* find_command(std::string_view name) {
  for (const Command& command : commands())
    if (command.parameters.name == name) return &command;
  return nullptr;
}

}  // namespace trocar::modeller
