#pragma once
// All frames of a film at a glance: a grid of small images.

#include "tungsten/image/Image.h"

#include <functional>
#include <vector>

namespace tungsten {

/// Which frames a sheet shows: all, or as many as it takes, evenly chosen, the first and the last among them.
std::vector<int> sheetFrames(int frames);

/// Frames in reading order, shrunk by whole numbers of pixels to their mean so that the sheet is about 2000 pixels wide
/// at most; lines between them are dark grey. `frameOf` gives linear images of one size.
Image contactSheet(const std::vector<int>& frames, const std::function<Image(int)>& frameOf);

} // namespace tungsten
