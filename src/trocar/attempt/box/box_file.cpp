#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/box/box_file.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/box/box_time.hpp>
#include <trocar/devices/box/frames.hpp>
#include <trocar/devices/box/serial_port.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::attempt {
namespace {

using devices::BoxActor;
using devices::BoxAxis;
using devices::BoxWiring;
namespace keys = scene::keys;

constexpr double kMostDegrees = 720, kMostMillimetres = 500;

/// Of an axis: its table's key, and how many of its units are one SI unit (a radian, a metre, all the way).
struct AxisUnit {
  const char* key;
  double per_ours;
};
AxisUnit unit_of(BoxActor actor, BoxAxis axis) {
  if (axis == BoxAxis::depth) return {"mm", 1000};
  if (axis == BoxAxis::handle && actor != BoxActor::scope) return {"closed", 1};
  return {"deg", 180 / portable::pi};
}

const char* axis_key(BoxActor actor, BoxAxis axis) {
  return actor == BoxActor::scope && axis == BoxAxis::handle ? "post" : devices::kBoxAxisNames[std::size_t(axis)];
}

scene::Key channel_key() { return scene::needed(keys::integer("channel", 0, devices::kBoxChannels - 1, "from 0")); }

const scene::Shape& angle_shape() {
  static const scene::Shape shape{
      "angle",
      "An axis that turns.",
      {channel_key(), scene::needed(keys::table("deg", -kMostDegrees, devices::kBoxTopCode, 2,
                                                "rows of code and angle: codes rise, angles rise or fall"))}};
  return shape;
}
const scene::Shape& depth_shape() {
  static const scene::Shape shape{
      "depth",
      "The depth along the shaft.",
      {channel_key(), scene::needed(keys::table("mm", -kMostMillimetres, devices::kBoxTopCode, 2,
                                                "rows of code and depth, 0 at the trocar: codes rise"))}};
  return shape;
}
const scene::Shape& handle_shape() {
  static const scene::Shape shape{"handle",
                                  "The closure of a handle.",
                                  {channel_key(), scene::needed(keys::table("closed", -1, devices::kBoxTopCode, 2,
                                                                            "rows of code and 0 open .. 1 closed"))}};
  return shape;
}
scene::Key bit_key(const char* name, const char* meaning) {
  return keys::integer(name, 0, devices::kBoxDigitalBits - 1, std::string("bit: ") + meaning);
}
const scene::Shape& hand_shape() {
  static const scene::Shape shape{
      "hand",
      "An instrument of the box. Axes without a channel stay where the scene places them.",
      {scene::needed(keys::choice("hand", {"left", "right", "third", "fourth"}, "which")),
       keys::object("yaw", angle_shape, "about the vertical of the box"),
       keys::object("pitch", angle_shape, "towards and away"), keys::object("roll", angle_shape, "about the shaft"),
       keys::object("depth", depth_shape, "along the shaft"), keys::object("handle", handle_shape, "of the jaws"),
       bit_key("next_instrument", "the next one of the rack"), bit_key("irrigate", "valve of a suction-irrigator"),
       bit_key("suck", "valve of a suction-irrigator")}};
  return shape;
}
const scene::Shape& scope_shape() {
  static const scene::Shape shape{
      "scope",
      "The endoscope.",
      {keys::object("yaw", angle_shape, "about the vertical of the box"),
       keys::object("pitch", angle_shape, "towards and away"), keys::object("roll", angle_shape, "of the camera head"),
       keys::object("depth", depth_shape, "along the shaft"), keys::object("post", angle_shape, "of the light post")}};
  return shape;
}
const scene::Shape& pedals_shape() {
  static const scene::Shape shape{
      "pedals",
      "Foot switches.",
      {bit_key("coagulate", "blue"), bit_key("cut", "yellow"), bit_key("wipe", "the lens is wiped"),
       bit_key("declare", "declares the target as shown"), bit_key("reset", "reset, when held for a second")}};
  return shape;
}
const scene::Shape& box_shape() {
  static const scene::Shape shape{
      "box",
      "The wiring and calibration of an instrument box.",
      {scene::needed(keys::format(1)), keys::integer("baud", 9600, 4'000'000, "of the line, default 38400"),
       keys::number("rate_hz", kLeastBoxRate, kMostBoxRate, "blocks a second, default 50"),
       keys::choice("protocol", {"framed", "raw"}, "default framed; raw: 76 bytes without frames"),
       keys::choice("zero", {"placed", "upright"},
                    "zero of the angles: the scene's pose (default), or the upright shaft"),
       keys::number("filter_hz", 0, 100, "corner of the low-pass at rest, default 5; 0: none"),
       keys::objects("hands", hand_shape, 0, "at most four"), keys::object("scope", scope_shape, "the endoscope"),
       keys::object("pedals", pedals_shape, "foot switches"),
       keys::numbers("closed_is_low", 0, devices::kBoxDigitalBits - 1, 0, "bits that are 0 while closed")}};
  return shape;
}

/// Double use is reported.
class Taken {
 public:
  explicit Taken(const char* what) : m_what(what) {}
  void take(const scene::JsonObject& o, const char* key, int number) {
    const std::uint64_t mask = std::uint64_t(1) << number;
    if ((m_taken & mask) != 0)
      o.fault(key, tr("expected a {} that is free, got {}, which is wired already", m_what, number));
    m_taken |= mask;
  }

 private:
  const char* m_what;
  std::uint64_t m_taken = 0;
};

class WiringReader {
 public:
  void read(const scene::JsonObject& o, BoxWiring& w) {
    w.baud = o.integer("baud", w.baud);
    if (!devices::known_baud(w.baud)) o.fault("baud", tr("expected a usual rate, got {}", w.baud));
    w.rate = o.number("rate_hz", w.rate);
    w.raw = o.text("protocol", "framed") == "raw";
    w.from_placed = o.text("zero", "placed") == "placed";
    w.filter.rest = o.number("filter_hz", w.filter.rest);
    read_hands(o, w);
    for (const scene::JsonObject& scope : o.objects("scope")) read_axes(scope, BoxActor::scope, w);
    for (const scene::JsonObject& pedals : o.objects("pedals"))
      for (std::size_t p = 0; p < devices::kBoxPedals; ++p) read_bit(pedals, devices::kBoxPedalNames[p], w.pedals[p]);
    for (const double bit : o.numbers("closed_is_low")) {
      if (bit == std::floor(bit))
        w.inverted |= 1u << int(bit);
      else
        o.fault("closed_is_low", tr("expected whole numbers, got {}", bit));
    }
    check_rate(o, w);
  }

 private:
  void read_hands(const scene::JsonObject& o, BoxWiring& w) {
    for (const scene::JsonObject& hand : o.objects("hands")) {
      const std::string name = hand.text("hand");
      const auto found = std::find(devices::kBoxActorNames.begin(), devices::kBoxActorNames.end(), name);
      if (name.empty() || found == devices::kBoxActorNames.end()) continue;  // told already
      const auto number = std::size_t(found - devices::kBoxActorNames.begin());
      if (w.has(BoxActor(number))) hand.fault("hand", tr("expected each hand once, got \"{}\" again", name));
      read_axes(hand, BoxActor(number), w);
      for (std::size_t b = 0; b < devices::kBoxButtons; ++b)
        read_bit(hand, devices::kBoxButtonNames[b], w.buttons[number][b]);
    }
  }

  void read_bit(const scene::JsonObject& o, const char* key, int& bit) {
    if (!o.has(key)) return;
    bit = o.integer(key);
    m_bits.take(o, key, bit);
  }

  void read_axes(const scene::JsonObject& o, BoxActor actor, BoxWiring& w) {
    for (int axis = 0; axis < devices::kBoxAxes; ++axis)
      for (const scene::JsonObject& wired : o.objects(axis_key(actor, BoxAxis(axis))))
        read_axis(wired, unit_of(actor, BoxAxis(axis)), w.axes[std::size_t(actor)][std::size_t(axis)]);
  }

  void read_axis(const scene::JsonObject& o, const AxisUnit& unit, devices::WiredAxis& axis) {
    if (!o.has("channel") || !o.has(unit.key)) return;  // told already
    const scene::NumberTable rows = o.table(unit.key);
    devices::AxisTable table;
    if (rows.columns != 2)
      return o.fault(unit.key, tr("expected rows of a code and a value, got {} columns", rows.columns));
    for (std::size_t row = 0; row < rows.rows; ++row) {
      table.codes.push_back(rows.values[2 * row]);
      table.values.push_back(rows.values[2 * row + 1] / unit.per_ours);
    }
    if (const std::string wrong = devices::unfit(table); !wrong.empty())
      return o.fault(unit.key, tr("expected {}, got another table", wrong));
    axis = {o.integer("channel"), std::move(table)};
    m_channels.take(o, "channel", axis.channel);
  }

  /// Do so many blocks go through the line?
  static void check_rate(const scene::JsonObject& o, const BoxWiring& w) {
    const std::size_t bytes = w.raw ? devices::kRawBlockBytes : devices::data_size(w.mask());
    const double most = devices::most_blocks(bytes, w.baud);
    if (w.rate > most)
      o.fault("rate_hz", tr("expected at most {:.1f}, as a block of {} bytes takes {:.2f} ms at {} Bd, got {}", most,
                            bytes, 1000 * devices::box_seconds(devices::time_on_line(bytes, w.baud)), w.baud, w.rate));
  }

  Taken m_channels{"channel"}, m_bits{"bit"};
};

Json axis_json(const devices::WiredAxis& axis, const AxisUnit& unit) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < axis.table.codes.size(); ++i)
    rows.push_back({axis.table.codes[i], std::round(axis.table.values[i] * unit.per_ours * 1e9) / 1e9});
  return {{"channel", axis.channel}, {unit.key, rows}};
}

Json actor_json(const BoxWiring& w, BoxActor actor) {
  Json o = Json::object();
  for (int axis = 0; axis < devices::kBoxAxes; ++axis)
    if (const devices::WiredAxis& wired = w.axis(actor, BoxAxis(axis)); wired.channel >= 0)
      o[axis_key(actor, BoxAxis(axis))] = axis_json(wired, unit_of(actor, BoxAxis(axis)));
  return o;
}

/// On one line what fits there.
void write(const Json& value, int indent, std::string& out) {
  constexpr std::size_t kLine = 100;
  if (const std::string line = value.dump(); !value.is_structured() || line.size() < kLine) {
    out += line;
    return;
  }
  const std::string pad(std::size_t(indent) + 2, ' ');
  out += value.is_array() ? "[" : "{";
  bool first = true;
  for (const auto& [key, item] : value.items()) {
    out += (first ? "\n" : ",\n") + pad;
    if (value.is_object()) out += Json(key).dump() + ": ";
    write(item, indent + 2, out);
    first = false;
  }
  out += "\n" + std::string(std::size_t(indent), ' ') + (value.is_array() ? "]" : "}");
}

}  // namespace

BoxWiring read_box_file(const std::filesystem::path& file, std::vector<core::Fault>& faults,
                        const scene::MemoryFiles* memory) {
  BoxWiring wiring;
  const scene::JsonDocument document = scene::load_json(file, faults, memory);
  const scene::JsonObject o(document.root, box_shape(), document.file, faults);
  WiringReader().read(o, wiring);
  return wiring;
}

BoxWiring load_wiring(const std::string& file) {
  std::error_code error;
  const std::filesystem::path own = data_folder() / "box.json";
  if (file.empty() && !std::filesystem::exists(own, error)) return devices::default_wiring();
  std::vector<core::Fault> faults;
  BoxWiring wiring = read_box_file(file.empty() ? own : std::filesystem::path(file), faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return wiring;
}

std::string box_file_text(const BoxWiring& w) {
  Json o{{"format", 1},
         {"baud", w.baud},
         {"rate_hz", w.rate},
         {"protocol", w.raw ? "raw" : "framed"},
         {"zero", w.from_placed ? "placed" : "upright"},
         {"filter_hz", w.filter.rest},
         {"hands", Json::array()}};
  for (std::size_t hand = 0; hand < devices::kBoxHands; ++hand) {
    if (!w.has(BoxActor(hand))) continue;
    Json one{{"hand", devices::kBoxActorNames[hand]}};
    one.update(actor_json(w, BoxActor(hand)));
    for (std::size_t b = 0; b < devices::kBoxButtons; ++b)
      if (w.buttons[hand][b] >= 0) one[devices::kBoxButtonNames[b]] = w.buttons[hand][b];
    o["hands"].push_back(one);
  }
  if (w.has(BoxActor::scope)) o["scope"] = actor_json(w, BoxActor::scope);
  Json pedals = Json::object();
  for (std::size_t p = 0; p < devices::kBoxPedals; ++p)
    if (w.pedals[p] >= 0) pedals[devices::kBoxPedalNames[p]] = w.pedals[p];
  o["pedals"] = pedals;
  Json low = Json::array();
  for (int bit = 0; bit < devices::kBoxDigitalBits; ++bit)
    if ((w.inverted >> bit & 1) != 0) low.push_back(bit);
  o["closed_is_low"] = low;
  std::string text;
  write(o, 0, text);
  return text + "\n";
}

}  // namespace trocar::attempt
