// Bodies of a test's own, as the interactions want to see them.
#pragma once

#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions::test {

struct FewBodies {
  BodyModels models;
  BodyStates states;
  BodyWork work;

  Bodies all() { return {models, states, &work}; }
  StrandBodyWork& add(const StrandBody& body, std::size_t loads = 256) {
    models.strand_bodies.push_back(body);
    states.strands.push_back(rest_state(body.model));
    work.strands.emplace_back().body = make_work(body.model);
    work.strands.back().loads.reserve(loads);
    return work.strands.back();
  }
};

}  // namespace trocar::interactions::test
