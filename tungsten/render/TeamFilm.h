#pragma once
// A film that the ranks of a team fold together, each some image rows of every pass.

#include "tungsten/film/Film.h"
#include "tungsten/render/Team.h"

namespace tungsten {

/// In every round each rank renders one pass; its rows go to the ranks that own them (Team::exchange), which fold the
/// passes in their order: the film's bits are those of one process. So each rank sends and receives about one film per
/// round, however many ranks there are, and rank 0 has the whole film only where somebody wants to see it. Without a
/// team the one process owns all rows, and nothing is moved.
class TeamFilm {
  public:
    /// The film must outlive this.
    TeamFilm(Team* team, Film& film);

    /// After a round: takes the pass images of the first `passes` ranks apart. Once, before they are folded.
    void collect(size_t passes);
    /// Folds the pass of this rank in; call it in the order of ranks.
    void fold(size_t rank, double weight);
    /// Rank 0's film becomes whole, with its figures.
    void gather();
    /// Every rank's film becomes that of rank 0 as far as it owns it.
    void scatter();
    /// By this rank, of passes' rows, to others.
    [[nodiscard]] uint64_t bytesSent() const { return bytesSent_; }

  private:
    [[nodiscard]] int firstRowOf(int rank) const;
    [[nodiscard]] std::vector<Bytes> rowsFor() const;
    /// Deviations of the passes since the last time, to rank 0.
    void settle();

    Team* team_;
    Film& film_;
    std::vector<Bytes> received_;    ///< rows of the round's passes, by rank
    std::vector<FoldedPass> folded_; ///< since settle()
    uint64_t bytesSent_ = 0;
    uint64_t told_ = 0; ///< non-finite samples that rank 0 knows of
};

} // namespace tungsten
