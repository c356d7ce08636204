#include "techniques/depth_sampling/visibility_measures.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace gfxrepro::depth_sampling {
VisibilityCounts& VisibilityCounts::operator+=(const VisibilityCounts& other) {
    samples += other.samples;
    redundant += other.redundant;
    occluded += other.occluded;
    occludedLiterally += other.occludedLiterally;
    useful += other.useful;
    return *this;
}

VisibilityCounts countSamples(const VisibilitySequence& sequence, std::size_t index,
                              const VisibilitySequence& conventional,
                              const VisibilitySequence& outputs) {
    const glm::ivec2 size = sequence.views()[index].sizePx;
    const std::size_t viewCount = conventional.views().size();
    const std::size_t earlierCount = std::min(index, viewCount);
    // The nearest points on a view's rays are what its conventional image holds, whatever rounding
    // makes of a ray that is cast to one of them again.
    const bool isConventional =
        index == 0 && viewCount > 0 && isSameView(sequence.views()[0], conventional.views()[0]);
    const auto countRows = [&](const tbb::blocked_range<int>& rows, VisibilityCounts counts) {
        std::size_t frameBefore = 0;
        for (int y = rows.begin(); y < rows.end(); ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto point = sequence.sample(index, {x, y});
                if (!point) continue;
                ++counts.samples;
                counts.redundant += sequence.isRedundant(index, *point) ? 1 : 0;
                if (conventional.anyHolds(earlierCount, *point)) continue;
                ++counts.occludedLiterally;
                if (isConventional || conventional.anyHolds(viewCount, *point)) continue;
                ++counts.occluded;
                const auto frame = outputs.visibleFrom(*point, frameBefore);
                if (!frame) continue;
                ++counts.useful;
                frameBefore = *frame;
            }
        }
        return counts;
    };
    return tbb::parallel_reduce(tbb::blocked_range<int>(0, size.y), VisibilityCounts{}, countRows,
                                [](VisibilityCounts a, const VisibilityCounts& b) {
                                    a += b;
                                    return a;
                                });
}

std::vector<VisibilityAvailability> countAvailable(const VisibilitySequence& sequence,
                                                   const VisibilitySequence& outputs) {
    std::vector<VisibilityAvailability> frames(outputs.views().size());
    const std::size_t imageCount = sequence.views().size();
    tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t frame) {
        const glm::ivec2 size = outputs.views()[frame].sizePx;
        VisibilityAvailability counts;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto point = outputs.sample(frame, {x, y});
                if (!point) continue;
                ++counts.samples;
                counts.available += sequence.anyHolds(imageCount, *point) ? 1 : 0;
            }
        }
        frames[frame] = counts;
    });
    return frames;
}

}  // namespace gfxrepro::depth_sampling
