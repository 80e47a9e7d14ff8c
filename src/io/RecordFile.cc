/// @file RecordFile.cc
/// Offsets, and the texts between the records.
#include "io/RecordFile.h"

namespace vdbtet {

void RecordLayout::text(std::string text) {
    const std::uint64_t at = mSize;
    mSize += text.size();
    mTexts.emplace_back(at, std::move(text));
}

RecordLayout::Section RecordLayout::records(std::int64_t count, std::size_t bytesEach) {
    const Section section{mSize, bytesEach};
    mSize += std::uint64_t(count) * bytesEach;
    return section;
}

void RecordFile::start(const RecordLayout& layout) {
    mFile.reserve(layout.size());
    for (const auto& [offset, text] : layout.mTexts) mFile.writeAt(offset, text.data(), text.size());
}

} // namespace vdbtet
