#pragma once
// What the module of a team exports (tungsten-mpi.so, looked for where plugins are):
//
//     extern "C" const tungsten::TeamModule* tungstenTeam();

#include "tungsten/render/Plugin.h"
#include "tungsten/render/Team.h"

namespace tungsten {

struct TeamModule {
    const char* abi;
    std::unique_ptr<Team> (*join)();
};

} // namespace tungsten
