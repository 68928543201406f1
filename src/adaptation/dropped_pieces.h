#pragma once

#include <vector>

#include "adaptation/working_network.h"

namespace fcn {

/// What adaptation did not keep, piece by piece, with what is known of the reasons.
class DroppedPieces {
public:
    explicit DroppedPieces(std::vector<DroppedPiece> pieces) : pieces_(std::move(pieces)) {}

    /// Samples [first, last] of an arc; `why` holds reason, label, blockers.
    void add(const WorkingArc& arc, int first, int last, int iteration, DroppedPiece why);
    /// A whole arc for one reason.
    void add(const WorkingArc& arc, int iteration, const char* reason, DroppedPiece why = {});
    /// Refilling brings dropped samples back; their pieces are not dropped any more.
    void forget_returned(const WorkingNetwork& network);
    std::vector<DroppedPiece> take() { return std::move(pieces_); }

private:
    std::vector<DroppedPiece> pieces_;
};

}  // namespace fcn
