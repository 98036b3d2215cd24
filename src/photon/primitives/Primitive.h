#pragma once
// What the operations of every primitive speak of.

#include "photon/primitives/KernelSettings.h"
#include "photon/primitives/NearSurfaces.h"
#include "photon/primitives/Radii.h"

#include <string>

namespace tungsten {
class Film;
class ObjectReader;
class ProgressToken;
} // namespace tungsten

namespace tungsten::photon {

struct PhotonSettings;
struct CameraRecord;
using CameraRecords = std::vector<const CameraRecord*>; ///< of several samples of a pass

} // namespace tungsten::photon
