// LAS 1.0 to 1.4 of the ASPRS, uncompressed: points of laser scans.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/image/srgb.h"
#include "engine/scene/left_out.h"
#include "engine/scene/load.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Where a record of a point's format has what; 0: nowhere.
struct PointFormat {
    std::uint8_t number = 0;
    std::size_t bytes = 0;
    std::size_t time = 0;
    std::size_t colour = 0;
    std::size_t infrared = 0;

    bool isExtended() const { return number >= 6; }  // LAS 1.4's, of other bits and angles
};
constexpr PointFormat kPointFormats[] = {
    {0, 20},     {1, 28, 20},     {2, 26, 0, 20},      {3, 34, 20, 28},
    {6, 30, 22}, {7, 36, 22, 30}, {8, 38, 22, 30, 36},
};

/// What a point's record says beside its place and colour, where it is not 0.
constexpr const char* kOtherFields[] = {"the intensity",  "the return",      "the class",
                                        "the scan angle", "the user's data", "the source",
                                        "the time",       "the infrared"};

class LasReader {
  public:
    LasReader(std::string_view bytes, std::string file, Anchor& anchor, LeftOut& leftOut)
        : bytes_(bytes), file_(std::move(file)), anchor_(anchor), leftOut_(leftOut) {}

    Scene read() {
        readHeader();
        readRecordsBefore();
        for (std::uint64_t i = 0; i < count_; ++i) readPoint(i);
        for (std::size_t i = 0; i < std::size(kOtherFields); ++i) {
            leftOut_.add(std::string(kOtherFields[i]) + " of a point", saidCounts_[i]);
        }
        leftOut_.add("a point that is marked as withheld", withheldCount_);
        leftOut_.add("a byte behind a point's record", count_ * (recordBytes_ - format_.bytes));
        if (scene_.points.positions.empty()) fail("each of its points is marked as withheld");
        settleColours();
        return std::move(scene_);
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(file_ + ": " + message);
    }

    template <class T>
    T at(std::uint64_t place) const {
        if (place > bytes_.size() || sizeof(T) > bytes_.size() - place) {
            fail(fmt::format("ends early: has {} bytes", bytes_.size()));
        }
        T value{};
        std::memcpy(&value, bytes_.data() + place, sizeof(value));
        return value;
    }

    void readHeader() {
        if (!bytes_.starts_with("LASF")) fail("is no LAS file: does not begin with 'LASF'");
        const unsigned major = at<std::uint8_t>(24), minor = at<std::uint8_t>(25);
        if (major != 1 || minor > 4) {
            fail(fmt::format("is of LAS {}.{}; 1.0 to 1.4 are allowed", major, minor));
        }
        const unsigned format = at<std::uint8_t>(104);
        if (format >= 64) {  // its two highest bits are those of laszip
            fail("is compressed (LAZ); allowed: LAS as it is, which laszip or PDAL make of it");
        }
        const auto* found = std::ranges::find(kPointFormats, format, &PointFormat::number);
        if (found == std::end(kPointFormats)) {
            fail(fmt::format("has points of format {}; 0 to 3 and 6 to 8 are allowed", format));
        }
        format_ = *found;
        recordBytes_ = at<std::uint16_t>(105);
        if (recordBytes_ < format_.bytes) {
            fail(fmt::format("has records of {} bytes; a point of format {} takes {}", recordBytes_,
                             format, format_.bytes));
        }
        firstPoint_ = at<std::uint32_t>(96);
        count_ = minor == 4 ? at<std::uint64_t>(247) : at<std::uint32_t>(107);
        if (minor == 4) {
            leftOut_.add("an extended variable-length record", at<std::uint32_t>(243));
        }
        if (firstPoint_ > bytes_.size() || count_ > (bytes_.size() - firstPoint_) / recordBytes_) {
            fail(fmt::format("has {} bytes; its {} points end at {}", bytes_.size(), count_,
                             static_cast<double>(firstPoint_) +
                                 static_cast<double>(count_) * static_cast<double>(recordBytes_)));
        }
        if (count_ == 0) fail("no points");
        for (int axis = 0; axis < 3; ++axis) {
            scale_[axis] = at<double>(131 + 8 * static_cast<std::uint64_t>(axis));
            offset_[axis] = at<double>(155 + 8 * static_cast<std::uint64_t>(axis));
            if (!std::isfinite(scale_[axis]) || scale_[axis] == 0.0 ||
                !std::isfinite(offset_[axis])) {
                fail(fmt::format(
                    "its scale is {:g} and its offset {:g}; finite numbers are allowed, "
                    "of scales but 0",
                    scale_[axis], offset_[axis]));
            }
        }
    }

    /// The variable-length records: they say where on Earth, and what programs like to keep.
    void readRecordsBefore() {
        constexpr std::uint64_t kRecordHead = 54;
        std::uint64_t place = at<std::uint16_t>(94);
        const auto count = at<std::uint32_t>(100);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (place + kRecordHead > firstPoint_) {
                fail(fmt::format("its variable-length record {} of {} ends behind its first point",
                                 i + 1, count));
            }
            const std::string_view user = bytes_.substr(place + 2, 16);
            const std::string_view name = user.substr(0, user.find('\0'));
            leftOut_.add(name == "LASF_Projection"
                             ? "the coordinate reference system"
                             : "a variable-length record of " + inQuotes(name));
            place += kRecordHead + at<std::uint16_t>(place + 20);
        }
    }

    void readPoint(std::uint64_t index) {
        const std::uint64_t place = firstPoint_ + index * recordBytes_;
        const auto flags = at<std::uint8_t>(place + 15);
        if ((flags & (format_.isExtended() ? 4U : 128U)) != 0) {
            ++withheldCount_;
            return;
        }
        glm::dvec3 position(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const auto steps = at<std::int32_t>(place + 4 * static_cast<std::uint64_t>(axis));
            position[axis] = steps * scale_[axis] + offset_[axis];
            requireNear(position[axis], [&](const std::string& problem) {
                fail(fmt::format("point {}: {}", index, problem));
            });
        }
        scene_.points.positions.push_back(anchor_.relative(position));
        const bool isExtended = format_.isExtended();
        const bool said[] = {
            at<std::uint16_t>(place + 12) != 0,
            at<std::uint8_t>(place + 14) != 0,
            flags != 0 || (isExtended && at<std::uint8_t>(place + 16) != 0),
            isExtended ? at<std::int16_t>(place + 18) != 0 : at<std::int8_t>(place + 16) != 0,
            at<std::uint8_t>(place + 17) != 0,
            at<std::uint16_t>(place + (isExtended ? 20 : 18)) != 0,
            format_.time != 0 && at<double>(place + format_.time) != 0.0,
            format_.infrared != 0 && at<std::uint16_t>(place + format_.infrared) != 0,
        };
        static_assert(std::size(said) == std::size(kOtherFields));
        for (std::size_t i = 0; i < std::size(said); ++i) saidCounts_[i] += said[i] ? 1U : 0U;
        if (format_.colour == 0) return;
        glm::vec3& colour = scene_.points.colors.emplace_back(0.0F);
        for (int c = 0; c < 3; ++c) {
            colour[c] =
                at<std::uint16_t>(place + format_.colour + 2 * static_cast<std::uint64_t>(c));
        }
    }

    /// 16 bits a channel; many programs write 8. A format with colours need not have any.
    void settleColours() {
        std::vector<glm::vec3>& colours = scene_.points.colors;
        float largest = 0.0F;
        for (const glm::vec3& c : colours) largest = std::max({largest, c.r, c.g, c.b});
        if (largest == 0.0F) {
            leftOut_.add("the colour of all points, which is black", !colours.empty());
            colours.clear();
            return;
        }
        const float whole = largest > 255.0F ? 65535.0F : 255.0F;
        if (whole == 255.0F) {
            scene_.warnings.push_back(
                fmt::format("colours up to {:g} are taken as parts of 255", largest));
        }
        for (glm::vec3& colour : colours) {
            for (int c = 0; c < 3; ++c) colour[c] = image::linearOf(colour[c] / whole);
        }
    }

    std::string_view bytes_;
    std::string file_;
    Anchor& anchor_;
    LeftOut& leftOut_;
    PointFormat format_;
    std::uint64_t firstPoint_ = 0, count_ = 0, recordBytes_ = 0;
    glm::dvec3 scale_{1.0}, offset_{0.0};
    std::array<std::size_t, std::size(kOtherFields)> saidCounts_{};
    std::size_t withheldCount_ = 0;
    Scene scene_;
};

}  // namespace

Scene loadLas(const std::filesystem::path& path) {
    const MappedFile mapped(path);
    return loadedNearOrigin([&](Anchor& anchor, LeftOut& leftOut) {
        return LasReader(mapped.text(), path.string(), anchor, leftOut).read();
    });
}

}  // namespace gfxrepro::scene
