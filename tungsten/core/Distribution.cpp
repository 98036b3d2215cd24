#include "tungsten/core/Distribution.h"

namespace tungsten {

Distribution1D::Distribution1D(const std::vector<float>& weights) : cumulative_(weights.size() + 1, 0.0) {
    for (size_t i = 0; i < weights.size(); ++i) cumulative_[i + 1] = cumulative_[i] + std::max(double(weights[i]), 0.0);
    total_ = cumulative_.back();
    const double count = double(weights.size());
    for (size_t i = 1; i < cumulative_.size(); ++i)
        cumulative_[i] = total_ > 0.0 ? cumulative_[i] / total_ : double(i) / count;
}

Distribution1D::Sample Distribution1D::sample(float u) const {
    // The first entry beyond u ends the chosen cell; cells of zero width are never chosen.
    const auto end = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, double(u));
    const size_t index = size_t(end - cumulative_.begin()) - 1;
    const double width = cumulative_[index + 1] - cumulative_[index];
    const double inside = width > 0.0 ? (double(u) - cumulative_[index]) / width : 0.0;
    return {index, float(width), std::clamp(float(inside), 0.0f, 0x1.fffffep-1f)};
}

float Distribution1D::probability(size_t index) const {
    return float(cumulative_[index + 1] - cumulative_[index]);
}

Distribution2D::Distribution2D(const std::vector<float>& weights, int columns, int rows)
    : columns_(columns), rows_(rows) {
    std::vector<float> rowSums;
    for (int row = 0; row < rows; ++row) {
        const auto first = weights.begin() + ptrdiff_t(row) * columns;
        conditional_.emplace_back(std::vector<float>(first, first + columns));
        rowSums.push_back(float(conditional_.back().total()));
    }
    marginal_ = Distribution1D(rowSums);
}

Vec2f Distribution2D::sample(const Vec2f& u, float& pdf) const {
    const auto row = marginal_.sample(u.y);
    const auto column = conditional_[row.index].sample(u.x);
    pdf = row.probability * column.probability * float(rows_) * float(columns_);
    return {(float(column.index) + column.remapped) / float(columns_),
            (float(row.index) + row.remapped) / float(rows_)};
}

float Distribution2D::pdf(const Vec2f& point) const {
    const int column = std::clamp(int(point.x * float(columns_)), 0, columns_ - 1);
    const int row = std::clamp(int(point.y * float(rows_)), 0, rows_ - 1);
    return marginal_.probability(size_t(row)) * conditional_[size_t(row)].probability(size_t(column)) * float(rows_) *
           float(columns_);
}

} // namespace tungsten
