#include "tungsten/io/Format.h"

#include "tungsten/core/Errors.h"

#include <cctype>

namespace tungsten {

// Each stands at the end of the format's file.
extern const OutputFormat ExrFormat, NpzFormat, Hdf5Format, PfmFormat, NpyFormat, PngFormat, SheetFormat, Mp4Format,
    GifFormat;

const std::vector<const OutputFormat*>& outputFormats() {
    static const std::vector<const OutputFormat*> formats{&ExrFormat, &NpzFormat,   &Hdf5Format, &PfmFormat, &NpyFormat,
                                                          &PngFormat, &SheetFormat, &Mp4Format,  &GifFormat};
    return formats;
}

namespace {

const OutputFormat* findFormat(const std::filesystem::path& file, OutputUses uses) {
    const std::string extension = extensionOf(file);
    for (const OutputFormat* format : outputFormats())
        if ((format->uses & uses) != 0 && format->extension == extension) return format;
    return nullptr;
}

std::vector<std::string> extensionsOf(OutputUses uses) {
    std::vector<std::string> extensions;
    for (const OutputFormat* format : outputFormats())
        if ((format->uses & uses) != 0) extensions.emplace_back(format->extension);
    return extensions;
}

} // namespace

const OutputFormat& formatOf(const std::filesystem::path& file, OutputUses uses) {
    const OutputFormat* format = findFormat(file, uses);
    if (!format) requireExtension(file, extensionsOf(uses));
    return *format;
}

bool hasFormat(const std::filesystem::path& file, OutputUses uses) {
    return findFormat(file, uses) != nullptr;
}

void requireExtension(const std::filesystem::path& file, const std::vector<std::string>& accepted) {
    const std::string extension = extensionOf(file);
    for (const std::string& known : accepted)
        if (known == extension) return;
    throw InputError(file.string(),
                     "unknown image type '" + file.extension().string() + "'; accepted: " + listOf(accepted));
}

std::string formatsText(OutputUses uses) {
    return listOf(extensionsOf(uses));
}

std::string formatsWithNotes(OutputUses uses) {
    std::vector<std::string> groups, names;
    const std::vector<const OutputFormat*>& formats = outputFormats();
    for (size_t i = 0; i < formats.size(); ++i) {
        if ((formats[i]->uses & uses) == 0) continue;
        names.emplace_back(formats[i]->extension);
        const bool goesOn = !formats[i]->note.empty() && i + 1 < formats.size() && (formats[i + 1]->uses & uses) != 0 &&
                            formats[i + 1]->note == formats[i]->note;
        if (goesOn) continue;
        groups.push_back(listOf(names) + (formats[i]->note.empty() ? "" : " " + std::string(formats[i]->note)));
        names.clear();
    }
    return listOf(groups);
}

std::string extensionOf(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

} // namespace tungsten
