#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/box/assistant.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>

namespace trocar::attempt {

using devices::BoxActor;
using devices::BoxAxis;

namespace {

constexpr devices::BoxTime kHeldFor = 500'000'000;  // [ns]
constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr std::size_t kLeastBlocks = 8;  // of a held axis: at 50 Hz 160 ms

const char* who(BoxActor actor) {
  switch (actor) {
    case BoxActor::left:
      return tr("left instrument");
    case BoxActor::right:
      return tr("right instrument");
    case BoxActor::third:
      return tr("third instrument");
    case BoxActor::fourth:
      return tr("fourth instrument");
    case BoxActor::scope:
      break;
  }
  return tr("endoscope");
}

bool is_post(BoxActor actor, BoxAxis axis) { return actor == BoxActor::scope && axis == BoxAxis::handle; }

std::string sweep_text(BoxActor actor, BoxAxis axis) {
  switch (axis) {
    case BoxAxis::yaw:
      return tr("Swing the {} from side to side over its full range. Move nothing else.", who(actor));
    case BoxAxis::pitch:
      return tr("Swing the {} towards the patient's head and feet over its full range. Move nothing else.", who(actor));
    case BoxAxis::roll:
      return tr("Turn the {} about its own shaft over its full range. Move nothing else.", who(actor));
    case BoxAxis::depth:
      return tr("Pull the {} out and push it in over its full range. Move nothing else.", who(actor));
    case BoxAxis::handle:
      break;
  }
  return is_post(actor, axis) ? tr("Turn the endoscope's light post by a full turn. Move nothing else.")
                              : tr("Open and close the handle of the {}. Move nothing else.", who(actor));
}

/// Where it shall be held; angles as kinematics/fulcrum.hpp has them.
std::string hold_text(BoxActor actor, BoxAxis axis, double value) {
  const double degrees = std::round(10 * value / kDegree) / 10;
  const auto leant = [&](const char* positive, const char* negative) {
    if (degrees == 0) return tr("Hold the {} upright: its shaft straight down.", who(actor));
    return tr("Lean the {} so that its tip points {:g} degrees towards the patient's {}, and hold it still.",
              who(actor), std::abs(degrees), degrees > 0 ? positive : negative);
  };
  switch (axis) {
    case BoxAxis::yaw:
      return leant("right", "left");
    case BoxAxis::pitch:
      return leant("head", "feet");
    case BoxAxis::depth:
      return tr("Put the tip of the {} {:g} mm deep, measured from the trocar, and hold it still.", who(actor),
                std::round(1e4 * value) / 10);
    case BoxAxis::roll:
      break;
    case BoxAxis::handle:
      if (is_post(actor, axis)) break;
      if (value <= 0) return tr("Open the handle of the {}, and hold it.", who(actor));
      if (value >= 1) return tr("Close the handle of the {}, and hold it.", who(actor));
      return tr("Close the handle of the {} by {:.0f} %, and hold it.", who(actor), 100 * value);
  }
  const std::string what = is_post(actor, axis) ? "the endoscope's light post" : tr("the {}", who(actor));
  if (degrees == 0) return tr("Turn {} to its middle, and hold it still.", what);
  return tr("Turn {} {:g} degrees {} from its middle, as seen from its handle, and hold it still.", what,
            std::abs(degrees), degrees > 0 ? "to the left" : "to the right");
}

const char* axis_word(BoxActor actor, BoxAxis axis) {
  switch (axis) {
    case BoxAxis::yaw:
      return tr("from side to side");
    case BoxAxis::pitch:
      return tr("to head and feet");
    case BoxAxis::roll:
      return tr("turning");
    case BoxAxis::depth:
      return tr("in and out");
    case BoxAxis::handle:
      break;
  }
  return is_post(actor, axis) ? "light post" : "handle";
}

/// At which values an axis is held. [rad], [m], 0 .. 1
std::vector<double> first_values(BoxActor actor, BoxAxis axis) {
  if (axis == BoxAxis::depth) return {0.05, 0.15, 0.25};
  if (axis == BoxAxis::yaw || axis == BoxAxis::pitch) return {-40 * kDegree, 0, 40 * kDegree};
  if (axis == BoxAxis::roll || is_post(actor, axis)) return {-90 * kDegree, 0, 90 * kDegree};
  return {0, 1};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

bool BoxParts::any() const {
  return pedals || std::any_of(actors.begin(), actors.end(), [](bool there) { return there; });
}

BoxAssistant::BoxAssistant(const devices::BoxWiring& basis, const BoxParts& parts) : m_wiring(basis) {
  const devices::BoxWiring none;
  m_wiring.axes = none.axes, m_wiring.pedals = none.pedals, m_wiring.buttons = none.buttons;
  m_wiring.inverted = 0;
  for (int actor = 0; actor < devices::kBoxActors; ++actor) {
    if (!parts.actors[std::size_t(actor)]) continue;
    for (int which = 0; which < devices::kBoxAxes; ++which) ask_axis(BoxActor(actor), BoxAxis(which));
    if (!parts.buttons || BoxActor(actor) == BoxActor::scope) continue;
    for (int button = 0; button < devices::kBoxButtons; ++button) ask_press(BoxActor(actor), -1, button);
  }
  if (parts.pedals)
    for (int pedal = 0; pedal < devices::kBoxPedals; ++pedal) ask_press(BoxActor::scope, pedal, -1);
  begin();
}

void BoxAssistant::ask_axis(BoxActor actor, BoxAxis which) {
  BoxQuestion q;
  q.actor = actor, q.axis = which;
  q.heading = core::with_capital(fmt::format("{}: {}", who(actor), axis_word(actor, which)));
  q.text = sweep_text(actor, which);
  m_questions.push_back(q);
  q.kind = BoxQuestion::Kind::hold;
  for (const double value : first_values(actor, which)) {
    q.value = value, q.text = hold_text(actor, which, value);
    m_questions.push_back(q);
  }
}

void BoxAssistant::ask_press(BoxActor actor, int pedal, int button) {
  constexpr std::array<const char*, devices::kBoxPedals> kPedals = {
      "the pedal for coagulation (blue)", "the pedal for cutting (yellow)", "the switch that wipes the endoscope",
      "the switch that declares the target as shown", "the switch that restarts (reset)"};
  constexpr std::array<const char*, devices::kBoxButtons> kButtons = {"the switch for the next instrument",
                                                                      "the valve that rinses", "the valve that sucks"};
  BoxQuestion q;
  q.kind = BoxQuestion::Kind::press;
  q.actor = actor, q.pedal = pedal, q.button = button;
  q.heading = pedal >= 0 ? "Foot switches" : core::with_capital(tr("{}: switches", who(actor)));
  q.text = tr("Press and release {}.", pedal >= 0 ? std::string(kPedals[std::size_t(pedal)])
                                                  : tr("{} of the {}", kButtons[std::size_t(button)], who(actor)));
  m_questions.push_back(q);
}

void BoxAssistant::begin() {
  m_begun = false;
  m_recent.clear();
  m_pressed = m_came_back = 0;
}

void BoxAssistant::see(const devices::BoxBlock& block, devices::BoxTime at) {
  m_recent.push_back({block, at});
  while (m_recent.front().at + kHeldFor < at) m_recent.pop_front();
  if (!m_begun) {
    m_begun = true;
    m_rest = block.digital;
    m_low.fill(devices::kBoxTopCode), m_high.fill(0);
  }
  const std::uint32_t changed = block.digital ^ m_rest;
  m_came_back |= m_pressed & ~changed;
  m_pressed |= changed;
  if (m_recent.size() < 3) return;
  // The middle of three: one block that came wrong moves nothing.
  const auto last = m_recent.rbegin();
  for (std::size_t c = 0; c < devices::kBoxChannels; ++c) {
    const double code =
        median({double(last[0].block.codes[c]), double(last[1].block.codes[c]), double(last[2].block.codes[c])});
    m_low[c] = std::min(m_low[c], code), m_high[c] = std::max(m_high[c], code);
  }
}

devices::WiredAxis& BoxAssistant::axis() {
  return m_wiring.axes[std::size_t(question().actor)][std::size_t(question().axis)];
}
const devices::WiredAxis& BoxAssistant::axis() const { return m_wiring.axis(question().actor, question().axis); }

bool BoxAssistant::channel_taken(int channel) const { return (m_wiring.mask() >> channel & 1) != 0; }

bool BoxAssistant::bit_taken(int bit) const {
  if (std::find(m_wiring.pedals.begin(), m_wiring.pedals.end(), bit) != m_wiring.pedals.end()) return true;
  return std::any_of(m_wiring.buttons.begin(), m_wiring.buttons.end(),
                     [bit](const auto& hand) { return std::find(hand.begin(), hand.end(), bit) != hand.end(); });
}

double BoxAssistant::range(int channel) const {
  return m_begun ? std::max(0.0, m_high[std::size_t(channel)] - m_low[std::size_t(channel)]) : 0;
}

/// Of the channels that have no axis yet; -1: none is left.
int BoxAssistant::most_moved(int except) const {
  int most = -1;
  for (int c = 0; c < devices::kBoxChannels; ++c)
    if (c != except && !channel_taken(c) && (most < 0 || range(c) > range(most))) most = c;
  return most;
}

double BoxAssistant::held_code(int channel) const {
  std::vector<double> codes;
  for (const Moment& m : m_recent) codes.push_back(double(m.block.codes[std::size_t(channel)]));
  // The mean of the middle half: noise is averaged, what came wrong left out.
  std::sort(codes.begin(), codes.end());
  const std::size_t quarter = codes.size() / 4;
  double sum = 0;
  for (std::size_t i = quarter; i < codes.size() - quarter; ++i) sum += codes[i];
  return sum / double(codes.size() - 2 * quarter);
}

/// Between the first and the ninth tenth of what came in the last half second.
double BoxAssistant::unrest(int channel) const {
  if (m_recent.empty()) return 0;
  std::vector<double> codes;
  for (const Moment& m : m_recent) codes.push_back(double(m.block.codes[std::size_t(channel)]));
  std::sort(codes.begin(), codes.end());
  return codes[codes.size() * 9 / 10] - codes[codes.size() / 10];
}

int BoxAssistant::found() const {
  if (done()) return -1;
  switch (question().kind) {
    case BoxQuestion::Kind::hold:
      return axis().channel;
    case BoxQuestion::Kind::sweep: {
      const int most = most_moved(-1);
      return most >= 0 && range(most) >= kLeastSweep ? most : -1;
    }
    case BoxQuestion::Kind::press:
      break;
  }
  for (int bit = 0; bit < devices::kBoxDigitalBits; ++bit)
    if ((m_pressed >> bit & 1) != 0 && !bit_taken(bit)) return bit;
  return -1;
}

double BoxAssistant::moved() const {
  if (done()) return 0;
  if (question().kind == BoxQuestion::Kind::hold) return unrest(axis().channel);
  const int most = question().kind == BoxQuestion::Kind::sweep ? most_moved(-1) : -1;
  return most < 0 ? 0 : range(most);
}

std::string BoxAssistant::why_not() const {
  if (done()) return tr("the calibration is complete");
  if (m_recent.empty()) return tr("the box sends no data");
  switch (question().kind) {
    case BoxQuestion::Kind::sweep:
      return why_not_swept();
    case BoxQuestion::Kind::hold:
      return why_not_held();
    case BoxQuestion::Kind::press:
      break;
  }
  return why_not_pressed();
}

std::string BoxAssistant::why_not_swept() const {
  const int most = most_moved(-1);
  if (most < 0) return tr("every channel has an axis already");
  if (range(most) < kLeastSweep) return tr("no free channel has moved by {:g} of its 4096 codes yet", kLeastSweep);
  if (const int second = most_moved(most); second >= 0 && range(second) > range(most) / 2)
    return tr("channels {} and {} both moved: move only this axis, or choose a channel", most, second);
  return {};
}

std::string BoxAssistant::why_not_held() const {
  if (m_recent.size() < kLeastBlocks) return tr("hold it");
  const int channel = axis().channel;
  if (const double by = unrest(channel); by > kMostUnrest)
    return tr("the axis is moving: by {:.0f} codes in half a second, {:g} are allowed", by, kMostUnrest);
  const double code = held_code(channel);
  for (const double other : axis().table.codes)
    if (std::abs(code - other) < kLeastApart) return tr("its reading equals that of the previous position");
  devices::AxisTable table = axis().table;
  const auto row = std::lower_bound(table.codes.begin(), table.codes.end(), code) - table.codes.begin();
  table.codes.insert(table.codes.begin() + row, code);
  table.values.insert(table.values.begin() + row, question().value);
  if (table.codes.size() < 2) return {};
  const std::string fault = devices::unfit(table);
  return fault.empty() ? "" : "this reading contradicts the previous positions: expected " + fault;
}

std::string BoxAssistant::why_not_pressed() const {
  int pressed = 0, whole = 0;
  for (int bit = 0; bit < devices::kBoxDigitalBits; ++bit)
    if ((m_pressed >> bit & 1) != 0 && !bit_taken(bit)) ++pressed, whole += int(m_came_back >> bit & 1);
  if (pressed == 0) return m_pressed != 0 ? "this contact is already assigned" : "nothing was pressed";
  if (pressed > 1) return tr("several contacts closed: press only this one");
  return whole == 1 ? "" : "let it go";
}

void BoxAssistant::remember() { m_past.push_back({m_at, m_questions, m_wiring}); }

std::string BoxAssistant::take() {
  if (std::string why = why_not(); !why.empty()) return why;
  remember();
  if (question().kind == BoxQuestion::Kind::sweep) {
    axis().channel = found();
  } else if (question().kind == BoxQuestion::Kind::hold) {
    devices::AxisTable& table = axis().table;
    const double code = std::round(10 * held_code(axis().channel)) / 10;
    const auto row = std::lower_bound(table.codes.begin(), table.codes.end(), code) - table.codes.begin();
    table.codes.insert(table.codes.begin() + row, code);
    table.values.insert(table.values.begin() + row, question().value);
  } else {
    const int bit = found();
    (question().pedal >= 0 ? m_wiring.pedals[std::size_t(question().pedal)]
                           : m_wiring.buttons[std::size_t(question().actor)][std::size_t(question().button)]) = bit;
    if ((m_rest >> bit & 1) != 0) m_wiring.inverted |= std::uint32_t(1) << bit;
  }
  ++m_at;
  begin();
  return {};
}

void BoxAssistant::set_value(double value) {
  if (done() || question().kind != BoxQuestion::Kind::hold) return;
  BoxQuestion& q = m_questions[m_at];
  q.value = value;
  q.text = hold_text(q.actor, q.axis, value);
}

void BoxAssistant::add_row(double value) {
  if (done() || question().kind != BoxQuestion::Kind::hold) return;
  BoxQuestion q = question();
  q.value = value;
  q.text = hold_text(q.actor, q.axis, value);
  std::size_t end = m_at;
  while (end < m_questions.size() && m_questions[end].kind == BoxQuestion::Kind::hold &&
         m_questions[end].actor == q.actor && m_questions[end].axis == q.axis)
    ++end;
  m_questions.insert(m_questions.begin() + std::ptrdiff_t(end), q);
}

std::string BoxAssistant::choose(int channel) {
  if (done() || question().kind != BoxQuestion::Kind::sweep) return tr("no channel is being assigned");
  if (channel < 0 || channel >= devices::kBoxChannels) return tr("there is no such channel");
  if (channel_taken(channel)) return tr("channel {} has an axis already", channel);
  remember();
  axis().channel = channel;
  ++m_at;
  begin();
  return {};
}

void BoxAssistant::skip() {
  if (done()) return;
  remember();
  const BoxQuestion q = question();
  if (q.kind == BoxQuestion::Kind::press) {
    ++m_at;
  } else {
    axis() = {};
    while (!done() && question().kind != BoxQuestion::Kind::press && question().actor == q.actor &&
           question().axis == q.axis)
      ++m_at;
  }
  begin();
}

void BoxAssistant::back() {
  if (m_past.empty()) return;
  m_at = m_past.back().at;
  m_questions = std::move(m_past.back().questions);
  m_wiring = std::move(m_past.back().wiring);
  m_past.pop_back();
  begin();
}

}  // namespace trocar::attempt
