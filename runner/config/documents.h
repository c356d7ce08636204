// What reports say of the documents themselves: `configs/documents.yaml`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gfxrepro::config {

/// The tables, figures and sections of a chapter: what follows the slash in their ids.
struct Chapter {
    std::string title;                     // "Chapter 2. Voxels"
    std::vector<std::string> experiments;  // "2.1", "figure-2.6"; of a section "2.5.3"
};

struct Document {
    std::string id;                 // "zju2005": the folder of its configs
    std::string title;              // in the sense of the document, one line
    std::vector<Chapter> chapters;  // in the document's order
};

/// The documents in the order of the file; none where the file is not there. Throws Error with
/// file:line:column for an unknown key, a missing one, and an experiment that two chapters name.
std::vector<Document> readDocuments(const std::filesystem::path& file);

}  // namespace gfxrepro::config
