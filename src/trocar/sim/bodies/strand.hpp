// Operations of strands: tubes and ligaments (tissue/strand/strand.hpp).
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/bodies/touching.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Loads start afresh.
void hang(StepContext& context, StrandRef strand) noexcept;
/// An instrument at it.
void touch(StepContext& context, StrandRef strand, HandContact& hand) noexcept;
/// Implicit, its ends where their hosts put them.
void advance(StepContext& context, StrandRef strand) noexcept;
/// What its ends then do to their hosts.
void pull_on_hosts(StepContext& context, StrandRef strand) noexcept;
void clamp_to_cavity(StepContext& context, StrandRef strand) noexcept;

/// An element is cut through.
Parting cut(StepContext& context, StrandRef strand, int element) noexcept;
bool can_tear(const Model& model, StrandRef strand) noexcept;
/// Where it is stretched beyond what it bears.
Parting tear(StepContext& context, StrandRef strand) noexcept;

/// How it came through the tick, and whether its loads found room.
tissue::StepReport report_of(const StepContext& context, StrandRef strand) noexcept;
bool overloaded(const StepContext& context, StrandRef strand) noexcept;

}  // namespace trocar::sim
