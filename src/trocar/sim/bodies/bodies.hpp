// The operations of all kinds of bodies, a file a kind: overloads of one name.
#pragma once

#include <trocar/sim/bodies/cuttable.hpp>
#include <trocar/sim/bodies/membrane.hpp>
#include <trocar/sim/bodies/objects.hpp>
#include <trocar/sim/bodies/solid.hpp>
#include <trocar/sim/bodies/strand.hpp>
