// Pixels, voxels and the like, one after another.
#pragma once

namespace gfxrepro::test {

/// The (row, column) of each cell of a grid, row by row: for (const auto [y, x] : grid(height,
/// width)).
template <class Index>
class Grid {
  public:
    struct Cell {
        Index row, column;
    };
    struct Iterator {
        Cell cell;
        Index columns;

        Cell operator*() const { return cell; }
        Iterator& operator++() {
            if (++cell.column == columns) cell = {cell.row + 1, 0};
            return *this;
        }
        bool operator!=(const Iterator& end) const { return cell.row != end.cell.row; }
    };

    Grid(Index rows, Index columns) : rows_(columns > 0 ? rows : 0), columns_(columns) {}
    Iterator begin() const { return {{0, 0}, columns_}; }
    Iterator end() const { return {{rows_ > 0 ? rows_ : 0, 0}, columns_}; }

  private:
    Index rows_, columns_;
};

template <class Index = int>
Grid<Index> grid(Index rows, Index columns) {
    return {rows, columns};
}

}  // namespace gfxrepro::test
