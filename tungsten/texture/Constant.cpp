#include "tungsten/texture/ModelReader.h"

namespace tungsten {

Texture ConstantTexture::read(const ModelReader& fields, const Texture&, Range range) {
    return Texture(fields.rgb("value", Rgb(0.0f), {"none", "the same everywhere"}, range));
}

} // namespace tungsten
