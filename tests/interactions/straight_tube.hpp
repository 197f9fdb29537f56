// A tube of 1.6 mm radius along x from 0 to 60 mm, elements of 2.5 mm, its start held: arc length is x.
#pragma once

#include <trocar/interactions/bodies/strand_body.hpp>

namespace trocar::interactions::test {

struct StraightTube {
  StrandBody body;
  tissue::StrandState state;

  explicit StraightTube(double radius = 0.0016, Vec3d start = {0, 0, 0}, Vec3d along = {1, 0, 0}) {
    tissue::StrandDescription d;
    constexpr int kElements = 24;
    constexpr double kSpacing = 0.0025;
    for (int i = 0; i <= kElements; ++i) {
      d.positions.push_back(start + kSpacing * i * along);
      body.arc.push_back(kSpacing * i);
    }
    d.radius.assign(kElements, radius);
    d.youngs_modulus = 60e3;
    d.law = {3, 30, 0.3};
    d.density = 1050;
    d.foundation.assign(kElements + 1, 2.0);
    d.prescribed.assign(kElements + 1, 0);
    d.prescribed[0] = 1;
    d.damping_time = 0.004;
    d.foundation_damping_time = 0.03;
    body.model = tissue::build(d, 1e-3);
    state = tissue::rest_state(body.model);
  }
};

}  // namespace trocar::interactions::test
