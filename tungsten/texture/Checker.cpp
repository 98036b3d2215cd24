#include "tungsten/texture/ModelReader.h"

namespace tungsten {

Texture CheckerTexture::read(const ModelReader& fields, const Texture&, Range range) {
    CheckerTexture checker;
    checker.onColor = fields.rgb("on_color", checker.onColor, {"none", "squares of one colour"}, range);
    checker.offColor = fields.rgb("off_color", checker.offColor, {"none", "squares of the other"}, range);
    checker.resU = int(fields.integer("res_u", checker.resU, {"none", "squares along u"}, {1, 1e9}));
    checker.resV = int(fields.integer("res_v", checker.resV, {"none", "squares along v"}, {1, 1e9}));
    return Texture(checker);
}

const Rgb& CheckerTexture::rgb(const Vec2f& uv) const {
    const auto isOdd = [](float coordinate, int count) {
        return std::fmod(std::floor(coordinate * float(count)), 2.0f) != 0.0f;
    };
    return isOdd(uv.x, resU) != isOdd(uv.y, resV) ? onColor : offColor;
}

Rgb CheckerTexture::maximum() const {
    const auto larger = [&](int c) { return std::max(onColor[c], offColor[c]); };
    return {larger(0), larger(1), larger(2)};
}

Rgb CheckerTexture::average() const {
    // Cells are on where column + row is odd: half of them, rounded down.
    const int64_t cells = int64_t(resU) * resV, lit = cells / 2;
    const float on = cells > 0 ? float(double(lit) / double(cells)) : 0.0f;
    return onColor * on + offColor * (1.0f - on);
}

} // namespace tungsten
