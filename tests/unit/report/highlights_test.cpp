// Which pictures stand for a document.
#include "runner/report/pages.h"

#include <cmath>

#include "tests/support/support.h"

namespace gfxrepro::report {
namespace {

using claims::ClaimResult;
using claims::Verdict;

ClaimResult claim(const std::string& id, Verdict verdict) {
    ClaimResult result;
    result.id = id;
    result.verdict = verdict;
    result.origin = config::ClaimSpec::Origin::Document;
    return result;
}

/// A page with pictures at these distances from their truths.
Page pageOf(const std::string& id, const config::Experiment& experiment,
            std::vector<ClaimResult> claims, const std::vector<double>& distances) {
    RunPart part;
    part.experiment = &experiment;
    part.claims = std::move(claims);
    for (const double distance : distances) {
        Shot shot;
        shot.caseId = id + std::to_string(distance);
        shot.name = shot.baseName = "image";
        shot.truth = "truth";
        shot.flip = "map";
        shot.flipMean = distance;
        part.shots.push_back(shot);
    }
    Page page;
    page.id = id;
    page.parts.push_back(std::move(part));
    return page;
}

std::vector<std::string> namesOf(const std::vector<Page>& pages) {
    std::vector<const Page*> all;
    for (const Page& page : pages) all.push_back(&page);
    std::vector<std::string> names;
    // Pictures are as different as their distances from the truth.
    const auto difference = [](std::size_t, const Shot& a, const Shot& b) {
        return std::abs(a.flipMean - b.flipMean);
    };
    for (const Highlight& one : highlightsOf(all, difference)) {
        names.push_back(one.page->id + ' ' + one.claim->id + ' ' +
                        std::to_string(one.shot->flipMean).substr(0, 3));
    }
    return names;
}

TEST(Highlights, AreThoseOfFurtherClaimsWhereFewPagesHavePictures) {
    const config::Experiment experiment;
    const auto holds = [](const char* id) { return claim(id, Verdict::Holds); };
    const std::vector<Page> pages = {
        pageOf("a", experiment, {holds("A1"), holds("A2"), claim("A3", Verdict::Ambiguous)},
               {0.2, 0.1, 0.3}),
        pageOf("b", experiment, {holds("B1"), claim("B2", Verdict::Fails)}, {0.1, 0.4}),
        pageOf("c", experiment, {holds("C1"), holds("C2")}, {0.5})};
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a A1 0.1", "a A2 0.2", "b B2 0.4", "b B1 0.1", "c C1 0.5"));
}

TEST(Highlights, AreOfSeveralOfAPageThoseThatLookLeastAlike) {
    const config::Experiment experiment;
    const auto holds = [](const char* id) { return claim(id, Verdict::Holds); };
    const std::vector<Page> pages = {
        pageOf("a", experiment, {holds("1"), holds("2")}, {0.10, 0.11}),
        pageOf("b", experiment, {holds("1"), holds("2"), holds("3")}, {0.1, 0.3, 0.6}),
        pageOf("c", experiment, {holds("1"), holds("2")}, {0.2, 0.5}),
        pageOf("d", experiment, {holds("1")}, {0.2})};
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a 1 0.1", "b 1 0.1", "b 3 0.6", "c 1 0.2", "c 2 0.5", "d 1 0.2"));
}

TEST(Highlights, AreOneEachOfSixPages) {
    const config::Experiment experiment;
    std::vector<Page> pages;
    for (const char* id : {"a", "b", "c", "d", "e", "f", "g"}) {
        pages.push_back(pageOf(
            id, experiment, {claim("1", Verdict::Holds), claim("2", Verdict::Holds)}, {0.1, 0.2}));
    }
    EXPECT_THAT(namesOf(pages),
                ElementsAre("a 1 0.1", "b 1 0.1", "c 1 0.1", "d 1 0.1", "e 1 0.1", "f 1 0.1"));
}

}  // namespace
}  // namespace gfxrepro::report
