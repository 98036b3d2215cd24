#include "support/Folders.h"

namespace tungsten::test {

std::filesystem::path binaryFolder() {
    return TEST_BINARY_FOLDER;
}
std::filesystem::path dataFolder() {
    return TEST_DATA_FOLDER;
}
std::filesystem::path corpusFolder() {
    return TEST_CORPUS_FOLDER;
}
std::filesystem::path sharedFolder() {
    return TEST_SHARED_FOLDER;
}

} // namespace tungsten::test
