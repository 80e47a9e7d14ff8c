#include "cuts/Cuts.h"

namespace vdbtet {

std::vector<TileSigns> findSigns(const Field& field, const std::vector<openvdb::Coord>& tiles,
                                 Interrupt& interrupt) {
    std::vector<TileSigns> signs(tiles.size());
    parallelRanges(std::int64_t(tiles.size()), interrupt, [&](std::int64_t begin, std::int64_t end) {
        const auto sampler = field.sampler();
        for (std::int64_t t = begin; t < end; ++t) signs[t] = sampler->signs(tiles[t]);
    });
    return signs;
}

Cuts findCuts(const Field& field, const Layout& layout, const std::vector<TileSigns>& signs,
              Interrupt& interrupt) {
    const std::int64_t tiles = std::int64_t(layout.surfaceTiles.size());
    Cuts cuts;

    cuts.cut.resize(tiles);
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const PaddedMask insideB = Surroundings(layout.neighbours[t]).signs(signs, bcc::B);
            for (int d = 0; d < bcc::kDirections; ++d) {
                const bcc::Step step = bcc::shortEdge(bcc::A, d);
                cuts.cut[t][d] = signs[t][bcc::A] ^ insideB.shifted(step.x, step.y, step.z);
            }
        }
    });

    cuts.first.resize(tiles);
    std::int64_t sum = 0;
    for (std::int64_t t = 0; t < tiles; ++t) {
        for (int d = 0; d < bcc::kDirections; ++d) {
            cuts.first[t][d] = sum;
            sum += cuts.cut[t][d].count();
        }
    }
    cuts.fractions.resize(sum);

    cuts.arrows.resize(tiles);
    std::vector<EdgeMasks> nearB(tiles); // cut edges nearer to their L_B end, still at their L_A end
    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        const auto sampler = field.sampler();
        for (std::int64_t t = begin; t < end; ++t) {
            float* fraction = cuts.fractions.data() + cuts.first[t][0];
            bool any = false;
            for (const TileMask& mask : cuts.cut[t]) any = any || mask.any();
            if (!any) continue;
            sampler->cutPoints(layout.surfaceTiles[t], cuts.cut[t], fraction);
            for (int d = 0; d < bcc::kDirections; ++d) {
                cuts.cut[t][d].forEach([&](int vertex) {
                    (*fraction++ <= 0.5f ? cuts.arrows[t][bcc::A] : nearB[t])[d].set(vertex);
                });
            }
        }
    });

    parallelRanges(tiles, interrupt, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t) {
            const Surroundings around(layout.neighbours[t]);
            for (int d = 0; d < bcc::kDirections; ++d) {
                // Seen from its L_B end the edge runs the opposite way.
                const bcc::Step step = bcc::shortEdge(bcc::B, bcc::opposite(d));
                cuts.arrows[t][bcc::B][bcc::opposite(d)] =
                    around.masks(nearB, d).shifted(step.x, step.y, step.z);
            }
        }
    });
    return cuts;
}

} // namespace vdbtet
