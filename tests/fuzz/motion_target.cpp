// The motion file reader, and the smooth curve through what it read.
#include <cmath>
#include <sstream>

#include <trocar/devices/motion_file.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

bool finite(const devices::HandMotion& m) {
  return std::isfinite(m.tip[0]) && std::isfinite(m.tip[1]) && std::isfinite(m.tip[2]) && std::isfinite(m.roll) &&
         std::isfinite(m.handle);
}
bool finite(const devices::MotionSample& s) {
  return std::isfinite(s.time) && finite(s.hands[0]) && finite(s.hands[1]);
}

void check(const devices::MotionTrial& trial) {
  require(trial.samples.size() >= 2, "a trial has at least two rows");
  for (std::size_t i = 0; i < trial.samples.size(); ++i) {
    require(finite(trial.samples[i]), "what was read is finite");
    require(i == 0 || trial.samples[i].time > trial.samples[i - 1].time, "time rises");
  }
  for (devices::Hand hand : {devices::Hand::left, devices::Hand::right}) {
    const devices::MotionBounds b = devices::bounds_of(trial, hand);
    require(std::isfinite(b.path_length) && std::isfinite(b.centroid[0]), "bounds are finite");
    const double c = devices::closure(trial.samples.back().hand(hand).handle, b);
    require(c >= 0 && c <= 1, "a handle closes between 0 and 1");
  }
  const devices::MotionCurve curve(trial);
  require(curve.ticks() <= std::uint64_t(devices::kMaxMotionDuration * 1000) + 2, "a trial has an end");
  for (int k = 0; k <= 16; ++k) require(finite(curve.at(curve.duration() * k / 16)), "the curve is finite");
  for (std::size_t i = 1; i < trial.samples.size() && i < 64; ++i)
    require(finite(curve.at(0.5 * (trial.samples[i - 1].time + trial.samples[i].time))), "between rows too");
}

}  // namespace

void motion_file(Bytes bytes) {
  std::istringstream in(text_of(bytes));
  try {
    for (const devices::MotionTrial& trial : devices::read_motion(in, "memory.csv")) check(trial);
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty(), "a refusal has a reason");
    require(int(bad.faults().size()) <= devices::kMaxMotionFaults + 1, "faults are bounded");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
  }
}

std::vector<Seed> motion_seeds() {
  return {{"plain", bytes_of("operator,trial,t_ms,xL,yL,zL,rollL,handleL,xR,yR,zR,rollR,handleR,subtask\n"
                             "A,1,0,0,0,0,0,1,10,0,0,0.1,0.5,1\n"
                             "A,1,1000,1,2,3,0.1,0.9,11,-1,2e0,0.2,0.4,1\n"
                             "A,1,2000,2,1,-3.5,0.2,0,12,-2,4,0.3,0.3,2\n"
                             "B,1,5,2,1,-3.5,0.2,0,12,-2,4,0.3,0.3,2\n"
                             "B,1,5.5,2,1,-3.5,0.2,0,12,-2,4,0.3,0.3,2\n")},
          {"turned", bytes_of("t_ms,trial,operator,handleR,rollR,zR,yR,xR,handleL,rollL,zL,yL,xL,more\r\n"
                              "0,1,A,0,0,0,0,0,0,0,0,0,0,x\r\n\r\n1e-3,1,A,1,1,1,1,1,1,1,1,1,1,y\r\n")}};
}

std::vector<std::string> motion_words() {
  return {"operator", "trial",   "t_ms",   "xL",   "yL",   "zL",  "rollL", "handleL", "xR",    "yR", "zR", "rollR",
          "handleR",  "subtask", "1e-308", "1e12", "-1e9", "nan", "\r\n",  "10000",   "0x1p3", "1e", ",,"};
}

}  // namespace trocar::fuzz
