#pragma once
// A table kept in a file between renders.

#include "darts/EdaTable.h"

#include <filesystem>
#include <optional>
#include <string>

namespace darts {

struct CachedEdaTable {
    EdaTable table;
    bool built = false;  // rather than read
    std::string warning; // empty unless the file was unfit or could not be written
};

/// The table of this albedo, g and resolution if the file holds it; else none, and in `reason` what is wrong with the
/// file.
[[nodiscard]] std::optional<EdaTable> loadEdaTable(const std::filesystem::path& file, float albedo, float g,
                                                   const EdaResolution& resolution, std::string& reason);

/// The table of this albedo, g and resolution: read from `file` if that holds it, otherwise built and written there, by
/// way of a temporary file and rename. The outcome is the same either way: a file that is damaged, of another version
/// or of other parameters is replaced, one that cannot be written is done without, and a link or another user's file
/// (but root's) is neither read nor touched; each is told in the warning. The temporary file is made anew, beside
/// `file`, under a random name. Throws only as EdaTable::build.
[[nodiscard]] CachedEdaTable loadOrBuildEdaTable(const std::filesystem::path& file, float albedo, float g,
                                                 const EdaResolution& resolution = {}, unsigned threads = 0);

} // namespace darts
