#include "tungsten/render/RoundAgreement.h"

namespace tungsten {

RoundAgreement RoundAgreement::among(SharedResult& shared, size_t ranks) const {
    const double firstBroken = whole ? double(ranks) : double(shared.rank());
    const auto most = shared.largest(
        {double(interrupted), double(timedOut), double(wantsFilm), -firstBroken, whole ? -1.0 : -brokenAt});
    RoundAgreement all;
    all.interrupted = most[0] > 0.0;
    all.timedOut = most[1] > 0.0;
    all.wantsFilm = most[2] > 0.0;
    all.wholePasses = size_t(-most[3]);
    all.whole = all.wholePasses == ranks;
    all.brokenAt = -most[4];
    return all;
}

} // namespace tungsten
