#include <algorithm>
#include <cattaneo/condense/trace.hpp>
#include <cattaneo/exchange/input_deck.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/exchange/numpy_file.hpp>
#include <cattaneo/exchange/read_stiffness.hpp>
#include <cattaneo/exchange/symmetric_entries.hpp>
#include <cattaneo/whole_file.hpp>
#include <cattaneo/words.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>

namespace cattaneo
{

namespace
{

using Matrix = NodalStiffness::Matrix;

/// Which matrix of a body a file has. It is read into NodalStiffness::K.
enum class Kind
{
   stiffness,
   mass
};

const char *word(Kind kind)
{
   return kind == Kind::stiffness ? "stiffness" : "mass";
}

bool any_row(int)
{
   return true;
}

std::string dof_name(const NodeDof &dof)
{
   return "node " + std::to_string(dof.node) + " direction " + std::to_string(dof.direction);
}

/// A plane body has no rotations and no displacements off the plane, a solid no rotations.
void require_direction(const LineReader &in, const NodeDof &dof, Formulation formulation)
{
   if (formulation == Formulation::space)
   {
      in.require(dof.direction >= 1 && dof.direction <= 3, "direction ", dof.direction,
                 " of node ", dof.node, ", must be 1, 2 or 3");
      return;
   }
   in.require(dof.direction == 1 || dof.direction == 2, "direction ", dof.direction,
              " of node ", dof.node, ", must be 1 or 2",
              dof.direction == 3
                 ? ": elements of CalculiX in plane stress keep their thickness; plane strain "
                   "with E (1 + 2ν)/(1 + ν)² and ν/(1 + ν) is the same without"
                 : "");
}

// --- Rows of no node ------------------------------------------------------------------------

/// Eliminates internal rows, K_bb - K_bi K_ii⁻¹ K_ib. Of a support only a diagonal of 1 is
/// left, because the true diagonal is lost: 1e36 was added to it. Internal rows of a mass must
/// be empty.
void drop(NodalStiffness &rows, const std::vector<bool> &supported, const std::string &file,
          Kind kind)
{
   std::vector<int> number(rows.dofs.size(), -1);
   std::array<int, 2> count{};
   std::vector<NodeDof> kept;
   for (std::size_t row = 0; row < rows.dofs.size(); ++row)
   {
      const bool internal = rows.dofs[row].node < 0;
      if (internal && supported[row]) { continue; }
      if (!internal) { kept.push_back(rows.dofs[row]); }
      number[row] = count[internal]++;
   }
   std::vector<Eigen::Triplet<double>> bb, ib, ii;
   for (int row = 0; row < rows.K.rows(); ++row)
   {
      for (Matrix::InnerIterator entry(rows.K, row); entry; ++entry)
      {
         const auto column = static_cast<int>(entry.col());
         if (number[row] < 0 || number[column] < 0) { continue; }
         if (row != column && (supported[row] || supported[column])) { continue; }
         const bool inside = rows.dofs[row].node < 0,
                    column_inside = rows.dofs[column].node < 0;
         if (!inside && column_inside) { continue; } // the transpose of K_ib
         if (inside && kind == Kind::mass)
         {
            require(entry.value() == 0, "file '", file,
                    "': an internal node has a mass, which cannot be eliminated, must have "
                    "none: use elements without internal nodes");
            continue;
         }
         (inside ? column_inside ? ii : ib : bb)
            .emplace_back(number[row], number[column], entry.value());
      }
   }
   Eigen::SparseMatrix<double> K(count[0], count[0]), coupling(count[1], count[0]),
      inner(count[1], count[1]);
   K.setFromTriplets(bb.begin(), bb.end());
   if (count[1] > 0 && kind == Kind::stiffness)
   {
      coupling.setFromTriplets(ib.begin(), ib.end());
      inner.setFromTriplets(ii.begin(), ii.end());
      const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(inner);
      require(factor.info() == Eigen::Success, "file '", file,
              "': the stiffness of its internal nodes is singular: they cannot be eliminated");
      const Eigen::SparseMatrix<double> inside = factor.solve(coupling);
      const Eigen::SparseMatrix<double> part = coupling.transpose() * inside;
      K -= 0.5 * (part + Eigen::SparseMatrix<double>(part.transpose()));
   }
   for (std::size_t row = 0; row < rows.dofs.size(); ++row)
   {
      if (supported[row] && number[row] >= 0 && rows.dofs[row].node > 0)
      {
         rows.fixed.push_back(number[row]);
      }
   }
   rows.supports_left_out = std::count(supported.begin(), supported.end(), true) > 0;
   rows.K = K;
   rows.dofs = kept;
}

// --- CalculiX ------------------------------------------------------------------------------

/// C3D8I has displacements of its own, which the matrix calls by numbers above those of all
/// nodes. @param numbers  the .dof file with the rows' nodes and directions
void read_calculix(const std::string &file, const std::string &numbers, const InputDeck &deck,
                   NodalStiffness &rows, Kind kind)
{
   LineReader dofs(numbers);
   while (dofs.next())
   {
      const std::string_view text = trimmed(dofs.line());
      const std::size_t point = text.find('.');
      dofs.require(point != std::string_view::npos, "'", text, "', must be node.direction");
      const NodeDof dof{dofs.integer(text.substr(0, point), "a node"),
                        dofs.integer(text.substr(point + 1), "a direction")};
      require_direction(dofs, dof, rows.formulation);
      rows.dofs.push_back(dof);
   }
   const auto size = static_cast<int>(rows.dofs.size());
   SymmetricEntries entries;
   LineReader in(file);
   while (in.next())
   {
      const std::vector<std::string_view> fields = in.words();
      in.require(fields.size() == 3, "'", trimmed(in.line()),
                 "', must be row, column and value");
      const int row = in.integer(fields[0], "a row"),
                column = in.integer(fields[1], "a column");
      in.require(std::min(row, column) >= 1 && std::max(row, column) <= size, "entry (", row,
                 ", ", column, "), must be within ", size, "×", size, ", which '", dofs.file(),
                 "' has");
      entries.add(row - 1, column - 1, in.number(fields[2], "an entry"));
   }
   rows.K = entries.matrix(
      size, file, [&](int row) { return dof_name(rows.dofs[row]); }, any_row, word(kind));
   bool own = false;
   for (const InputDeck::Element &element : deck.elements)
   {
      own = own || element.type == "C3D8I";
   }
   if (!own) { return; }
   for (NodeDof &dof : rows.dofs)
   {
      if (rows.places.count(dof.node) == 0) { dof.node = -dof.node; }
   }
   drop(rows, std::vector<bool>(rows.dofs.size(), false), file, kind);
}

// --- ABAQUS --------------------------------------------------------------------------------

/// Which rows a matrix of FORMAT=COORDINATE has: all directions of each node that has an
/// element, by the numbers of nodes.
std::vector<NodeDof> numbered_rows(const InputDeck &deck)
{
   std::set<int> nodes;
   for (const InputDeck::Element &element : deck.elements)
   {
      nodes.insert(element.nodes.begin(), element.nodes.end());
   }
   std::vector<NodeDof> rows;
   for (int node : nodes)
   {
      for (int d = 1; d <= components(deck.formulation); ++d) { rows.push_back({node, d}); }
   }
   return rows;
}

/// InputError if a matrix with numbered rows connects nodes that no element connects, because
/// its rows then belong to other nodes than assumed.
void require_elements_connect(const NodalStiffness &rows, const InputDeck &deck,
                              const std::string &file)
{
   std::map<int, std::set<int>> neighbours;
   for (const InputDeck::Element &element : deck.elements)
   {
      for (int node : element.nodes)
      {
         neighbours[node].insert(element.nodes.begin(), element.nodes.end());
      }
   }
   for (int row = 0; row < rows.K.rows(); ++row)
   {
      for (Matrix::InnerIterator entry(rows.K, row); entry; ++entry)
      {
         const int one = rows.dofs[row].node, other = rows.dofs[entry.col()].node;
         require(entry.value() == 0 || neighbours[one].count(other) == 1, "file '", file,
                 "': its row ", row + 1, ", taken for ", dof_name(rows.dofs[row]),
                 ", is coupled to row ", entry.col() + 1, ", taken for ",
                 dof_name(rows.dofs[entry.col()]),
                 ", but no element has both. The rows are numbered in another way: write the "
                 "matrix with FORMAT=MATRIX INPUT, which names nodes");
      }
   }
}

/// Lines of node, direction, node, direction and value (FORMAT=MATRIX INPUT), or of row, column
/// and value (FORMAT=COORDINATE).
void read_abaqus_sparse(const std::string &file, const InputDeck &deck, NodalStiffness &rows,
                        Kind kind)
{
   SymmetricEntries entries;
   std::map<NodeDof, int> number;
   std::vector<bool> supported;
   std::size_t count = 0; // of words in a line
   LineReader in(file);
   while (in.next())
   {
      if (in.line()[0] == '*') { continue; } // *MATRIX INPUT, or a comment
      const std::vector<std::string_view> fields = in.words();
      if (count == 0) // the first line tells which
      {
         count = fields.size();
         if (count == 3)
         {
            rows.dofs = numbered_rows(deck);
            supported.assign(rows.dofs.size(), false);
         }
      }
      in.require(fields.size() == count && (count == 3 || count == 5), "'", trimmed(in.line()),
                 "', must be node, direction, node, direction and value, or row, column and "
                 "value, in all lines alike");
      std::array<int, 2> at{};
      for (std::size_t k : {0, 1})
      {
         if (count == 3)
         {
            const int row = in.integer(fields[k], "a row");
            in.require(row >= 1 && row <= static_cast<int>(rows.dofs.size()), "row ", row,
                       ", must be from 1 to ", rows.dofs.size(),
                       components(deck.formulation) == 3 ? ", three" : ", two",
                       " for each node that has an element in the deck");
            at[k] = row - 1;
            continue;
         }
         const NodeDof dof{in.integer(fields[2 * k], "a node"),
                           in.integer(fields[2 * k + 1], "a direction")};
         in.require(dof.node != 0,
                    "node 0, must be positive (a node) or negative (an internal node)");
         if (dof.node > 0) { require_direction(in, dof, deck.formulation); }
         at[k] = number.emplace(dof, static_cast<int>(rows.dofs.size())).first->second;
         if (at[k] == static_cast<int>(rows.dofs.size()))
         {
            rows.dofs.push_back(dof);
            supported.push_back(false);
         }
      }
      double value = in.number(fields.back(), "an entry");
      constexpr double support = 1e36;
      if (at[0] == at[1] && value >= 0.5 * support)
      {
         supported[at[0]] = true;
         value = 1; // the value before is lost
      }
      // Multipliers, of internal nodes, have diagonals of any sign: judged when eliminated.
      entries.add(at[0], at[1], value);
   }
   const auto size = static_cast<int>(rows.dofs.size());
   rows.K = entries.matrix(
      size, file, [&](int row) { return dof_name(rows.dofs[row]); },
      [&](int row) { return rows.dofs[row].node > 0; }, word(kind));
   if (count == 3) { require_elements_connect(rows, deck, file); }
   drop(rows, supported, file, kind);
}

/// *USER ELEMENT: nodes in a comment, directions of the first node and of those from which on
/// they change, then the triangle of the stiffness.
void read_user_element(const std::string &file, NodalStiffness &rows)
{
   LineReader in(file);
   std::vector<int> nodes;
   std::map<int, std::vector<int>> directions; // from a position among the nodes on
   std::vector<double> values;
   int count = 0;
   enum class Expected
   {
      nothing,
      nodes,
      directions,
      stiffness
   } expected = Expected::nothing;
   while (in.next())
   {
      const std::string line = upper_case(in.line());
      const auto says = [&](const char *words)
      { return line.find(words) != std::string::npos; };
      if (line.rfind("**", 0) == 0)
      {
         if (expected == Expected::nodes) { in.add_integers(nodes, "a node"); }
         if (says("ELEMENT NODES")) { expected = Expected::nodes; }
         continue;
      }
      if (says("*USER ELEMENT"))
      {
         const std::size_t place = line.find("NODES=");
         in.require(place != std::string::npos && !says("UNSYMM"),
                    "*USER ELEMENT, must have NODES= and not be UNSYMM");
         const std::string_view number = std::string_view(line).substr(place + 6);
         count = in.integer(trimmed(number.substr(0, number.find(','))), "the number of nodes");
         expected = Expected::directions;
      }
      else if (line[0] == '*')
      {
         const bool stiffness = says("*MATRIX") && says("STIFFNESS");
         in.require(!stiffness || values.empty(),
                    "a second *MATRIX, TYPE=STIFFNESS begins, must be one in a file");
         expected = stiffness ? Expected::stiffness : Expected::nothing;
      }
      else if (expected == Expected::stiffness)
      {
         for (const std::string_view word : in.words())
         {
            values.push_back(in.number(word, "an entry"));
         }
      }
      else if (expected != Expected::nothing)
      {
         expected = Expected::directions;
         std::vector<int> numbers;
         if (directions.empty()) { numbers.push_back(1); } // of the first node
         in.add_integers(numbers, "a direction");
         in.require(numbers.size() > 1 && numbers[0] >= 1 && numbers[0] <= count, "'",
                    trimmed(in.line()),
                    "', must be directions of the nodes of the element, of ", count,
                    ", behind the position of the first");
         for (std::size_t k = 1; k < numbers.size(); ++k)
         {
            require_direction(in, {numbers[0], numbers[k]}, rows.formulation);
         }
         directions[numbers[0]].assign(numbers.begin() + 1, numbers.end());
      }
   }
   require(count > 0 && static_cast<int>(nodes.size()) == count && !directions.empty(),
           "file '", file, "': a user element of ", count, " nodes lists ", nodes.size(),
           " of them, must list all of them in a comment after '** ELEMENT NODES', and their "
           "directions");
   for (int k = 0; k < count; ++k)
   {
      const auto &of = std::prev(directions.upper_bound(k + 1))->second;
      for (int direction : of) { rows.dofs.push_back({nodes[k], direction}); }
   }
   const auto size = static_cast<int>(rows.dofs.size());
   require(values.size() == std::size_t(size) * (size + 1) / 2, "file '", file,
           "': ", values.size(), " entries of a stiffness of ", size,
           " rows, its triangle must have ", std::size_t(size) * (size + 1) / 2);
   SymmetricEntries entries;
   for (int row = 0, k = 0; row < size; ++row)
   {
      for (int column = 0; column <= row; ++column) { entries.add(row, column, values[k++]); }
   }
   rows.K = entries.matrix(size, file, [&](int row) { return dof_name(rows.dofs[row]); });
   rows.supports_left_out = true; // those of its inside, if it has any
}

// --- MatrixMarket, NumPy ---------------------------------------------------------------------

std::string row_number(int row)
{
   return "row " + std::to_string(row + 1);
}

Matrix read_matrix_market(const std::string &file, Kind kind = Kind::stiffness)
{
   LineReader in(file);
   in.next();
   const std::string banner = upper_case(in.line());
   const auto says = [&](const char *word) { return banner.find(word) != std::string::npos; };
   in.require(
      says("MATRIX") && (says("REAL") || says("INTEGER")) &&
         (says("SYMMETRIC") || says("GENERAL")) && !says("SKEW") &&
         (says("COORDINATE") || says("ARRAY")),
      "'", trimmed(in.line()),
      "', must be %%MatrixMarket matrix coordinate (or array) real symmetric (or general)");
   const bool array = says("ARRAY"), triangle = says("SYMMETRIC");
   const auto next = [&]
   {
      while (in.next())
      {
         if (in.line()[0] != '%') { return true; }
      }
      return false;
   };
   require(next(), "file '", file, "' ends before the size of its matrix");
   std::vector<std::string_view> fields = in.words();
   in.require(fields.size() == (array ? 2 : 3), "'", trimmed(in.line()),
              "', must be the size of the matrix");
   const int size = in.integer(fields[0], "the number of rows");
   in.require(size > 0 && in.integer(fields[1], "the number of columns") == size,
              "the matrix is ", fields[0], "×", fields[1], ", must be square");
   const long stated = array ? triangle ? long(size) * (size + 1L) / 2 : long(size) * size
                             : in.integer(fields[2], "the number of entries");
   in.require(stated >= size, stated, " entries for ", size,
              " rows, must be at least one for each row");
   SymmetricEntries entries;
   int row = 0, column = 0; // of an array, by columns
   long count = 0;
   for (; next(); ++count)
   {
      in.require(count < stated, "there are more entries than the ", stated,
                 " that the file states, must be equally many");
      fields = in.words();
      in.require(fields.size() == (array ? 1 : 3), "'", trimmed(in.line()), "', must be ",
                 array ? "one entry" : "row, column and value");
      if (!array)
      {
         row = in.integer(fields[0], "a row");
         column = in.integer(fields[1], "a column");
         in.require(std::min(row, column) > 0 && std::max(row, column) <= size, "entry (", row,
                    ", ", column, "), must be within ", size, "×", size);
         --row;
         --column;
      }
      entries.add(row, column, in.number(fields.back(), "an entry"));
      if (array && ++row == size) { row = triangle ? ++column : (++column, 0); }
   }
   require(count == stated, "file '", file, "' is cut short: it has ", count, " of ", stated,
           " entries");
   return entries.matrix(size, file, row_number, any_row, word(kind));
}

/// The arrays of an .npz; of an .npy its one, `K`.
class NumpyArrays
{
public:
   explicit NumpyArrays(const std::string &file) : file_(file)
   {
      const std::string content = read_whole(file);
      const bool archive = std::filesystem::path(file).extension() == ".npz";
      files_ = archive ? stored_files(content, file)
                       : std::map<std::string, std::string>{{"K.npy", content}};
   }
   bool has(const std::string &name) const { return files_.count(name + ".npy") == 1; }
   NumpyArray operator()(const std::string &name) const
   {
      require(has(name), "file '", file_, "' has no array '", name,
              "', must have K, or data, indices, indptr and shape (scipy's csr or csc)");
      return numpy_array(files_.at(name + ".npy"), file_ + "/" + name);
   }
   /// Columns of whole numbers, one of which may be a list; InputError for others.
   Eigen::MatrixXi whole(const std::string &name, Eigen::Index columns) const
   {
      NumpyArray array = (*this)(name);
      if (array.shape.size() == 1) { array.shape.push_back(1); }
      const Eigen::MatrixXd all = array.matrix(file_ + "/" + name);
      require(all.cols() == columns && (all.array() == all.array().round()).all() &&
                 (all.array().abs() < 2e9).all(),
              "file '", file_, "': its array '", name, "' is ", all.rows(), "×", all.cols(),
              ", must be ", columns, " columns of whole numbers");
      return all.cast<int>();
   }
   /// The rest of the names of arrays that begin with a word.
   std::vector<std::string> named(const std::string &word) const
   {
      std::vector<std::string> names;
      for (const auto &[name, content] : files_)
      {
         if (name.rfind(word + ' ', 0) != 0) { continue; }
         names.push_back(name.substr(word.size() + 1, name.size() - word.size() - 5));
      }
      return names;
   }

private:
   const std::string file_;
   std::map<std::string, std::string> files_;
};

Matrix read_numpy(const NumpyArrays &array, const std::string &file,
                  Kind kind = Kind::stiffness)
{
   SymmetricEntries entries;
   Eigen::Index size = 0;
   const auto finite = [&](Eigen::Index i, Eigen::Index j, double value)
   {
      require(std::isfinite(value), "file '", file, "': entry (row ", i + 1, ", row ", j + 1,
              ") is ", value, ", must be finite");
      entries.add(static_cast<int>(i), static_cast<int>(j), value);
   };
   const char *own = kind == Kind::mass && array.has("M") ? "M" : "K";
   require(kind == Kind::stiffness || *own == 'M' || !array.has("dofs"), "file '", file,
           "' has no array 'M', must have one: its matrix is a stiffness");
   if (array.has(own))
   {
      const Eigen::MatrixXd K = array(own).matrix(file);
      size = K.rows();
      require(size > 0 && K.cols() == size, "file '", file, "': its matrix is ", size, "×",
              K.cols(), ", must be square");
      for (Eigen::Index j = 0; j < size; ++j)
      {
         for (Eigen::Index i = 0; i < size; ++i)
         {
            if (K(i, j) != 0) { finite(i, j, K(i, j)); }
         }
      }
   }
   else
   {
      const NumpyArray data = array("data"), indices = array("indices"),
                       start = array("indptr"), shape = array("shape");
      const std::size_t count = data.values.size(), rows = start.values.size();
      const auto whole = [](double number) { return number == std::floor(number); };
      size = static_cast<Eigen::Index>(rows) - 1;
      require(data.shape.size() == 1 && indices.values.size() == count && rows > 1 &&
                 shape.values == std::vector<double>(2, double(size)) && start.values[0] == 0 &&
                 std::all_of(start.values.begin(), start.values.end(), whole) &&
                 std::is_sorted(start.values.begin(), start.values.end()) &&
                 start.values.back() == double(count),
              "file '", file,
              "': its data, indices, indptr and shape are no square matrix in "
              "scipy's csr or csc");
      for (Eigen::Index i = 0; i < size; ++i)
      {
         for (auto k = std::size_t(start.values[i]); k < std::size_t(start.values[i + 1]); ++k)
         {
            const double j = indices.values[k];
            require(whole(j) && j >= 0 && j < double(size), "file '", file, "': row ", i + 1,
                    " has index ", j, ", must be an integer from 0 to ", size - 1);
            finite(i, static_cast<Eigen::Index>(j), data.values[k]);
         }
      }
   }
   return entries.matrix(static_cast<int>(size), file, row_number, any_row, word(kind));
}

// --- where nodes are -------------------------------------------------------------------------

/// Supports and loads of a file, by nodes and directions.
class Entries
{
public:
   explicit Entries(NodalStiffness &stiffness) : stiffness_(stiffness), rows_(stiffness.rows())
   {
   }
   bool has_row(const NodeDof &dof) const { return rows_.count(dof) == 1; }
   void fix(const NodeDof &dof)
   {
      std::vector<int> &fixed = stiffness_.fixed;
      const int row = rows_.at(dof);
      const auto place = std::lower_bound(fixed.begin(), fixed.end(), row);
      if (place == fixed.end() || *place != row) { fixed.insert(place, row); }
   }
   void add(const std::string &load, Control control, const NodeDof &dof, double value)
   {
      stiffness_.load_of(load, control).values[rows_.at(dof)] += value;
      if (control == Control::displacement) { fix(dof); }
   }

private:
   NodalStiffness &stiffness_;
   const std::map<NodeDof, int> rows_;
};

/// Applies the cards of a deck to the rows of its matrix. A force without a row is ignored only
/// if the deck itself holds that dof. Otherwise the row may be missing because it was
/// eliminated, or by mistake.
void add_cards(const std::vector<Card> &cards, const std::string &file, NodalStiffness &result)
{
   Entries entries(result);
   // held: dofs that a card supports or moves. lost: dofs that are fixed in the matrix. No load
   // can move them, because the matrix has lost the forces of their rows.
   std::set<NodeDof> held, lost;
   for (int row : result.fixed) { lost.insert(result.dofs[row]); }
   for (const Card &card : cards)
   {
      if (card.control == Control::force) { continue; }
      for (const Card::Value &each : card.values) { held.insert(each.at); }
   }
   for (const Card &card : cards)
   {
      const bool moves = card.control == Control::displacement;
      for (const auto &[at, value] : card.values)
      {
         require(at.direction <= components(result.formulation) || value == 0, "file '", file,
                 "': '", card.name, "' loads ", dof_name(at),
                 ", the direction of a force must be ",
                 components(result.formulation) == 3 ? "1, 2 or 3" : "1 or 2");
         const bool there = entries.has_row(at) && !(value != 0 && lost.count(at) == 1);
         result.supports_left_out = result.supports_left_out || (moves && !there);
         require(there || (moves ? value == 0 : held.count(at) == 1), "file '", file, "': '",
                 card.name, moves ? "' moves " : "' loads ", dof_name(at),
                 ", but the matrix has no row for it, it must be without support in the step "
                 "that writes the matrix");
         if (!there) { continue; } // a force on a held dof
         if (moves && value == 0) { entries.fix(at); }
         else { entries.add(card.name, card.control, at, value); }
      }
   }
}

/// Nodes of a deck, their sets (also those of element sets and surfaces) and edges.
void take_nodes(InputDeck &deck, NodalStiffness &result)
{
   std::map<std::string, std::set<int>> known;
   for (const auto &[name, nodes] : deck.node_sets)
   {
      known[name].insert(nodes.begin(), nodes.end());
   }
   const auto add = [&](const std::string &name, const NodalStiffness::Nodes &nodes)
   {
      for (int node : nodes)
      {
         if (known[name].insert(node).second) { deck.node_sets[name].push_back(node); }
      }
   };
   for (const auto &[name, elements] : deck.element_sets)
   {
      for (std::size_t e : elements) { add(name, deck.elements[e].nodes); }
   }
   for (const auto &[name, edges] : deck.surfaces)
   {
      for (const NodalStiffness::Nodes &edge : edges) { add(name, edge); }
   }
   result.formulation = deck.formulation;
   result.places = std::move(deck.places);
   result.z = std::move(deck.z);
   result.faces = std::move(deck.faces);
   result.sets = std::move(deck.node_sets);
   result.edges = std::move(deck.edges);
}

/// Reads the `.dofs` file that names the rows of a matrix.
void read_dofs(const std::string &file, NodalStiffness &result)
{
   const auto each_line = [&](const auto &visit)
   {
      LineReader in(file);
      while (in.next())
      {
         const std::vector<std::string_view> fields = in.words();
         if (!fields.empty() && fields[0].substr(0, 1) != "#") { visit(in, fields); }
      }
   };
   const auto is_word = [](std::string_view field)
   { return !field.empty() && std::isalpha(static_cast<unsigned char>(field[0])); };
   const auto dof_at =
      [&](const LineReader &in, std::string_view node, std::string_view direction)
   {
      const NodeDof dof{in.integer(node, "a node"), in.integer(direction, "a direction")};
      require_direction(in, dof, result.formulation);
      return dof;
   };
   each_line(
      [&](const LineReader &in, const std::vector<std::string_view> &fields)
      {
         if (is_word(fields[0])) { return; }
         // The first row tells whether all rows are of a body in space.
         const bool first = result.dofs.empty();
         if (first && fields.size() == 5) { result.formulation = Formulation::space; }
         const bool in_space = result.formulation == Formulation::space;
         in.require(fields.size() == (in_space ? 5 : 4), "'", trimmed(in.line()),
                    "', must be node, direction, x and y",
                    in_space ? ", and z as in the first row"
                    : first  ? ", or node, direction, x, y and z"
                             : "");
         const NodeDof dof = dof_at(in, fields[0], fields[1]);
         const Eigen::Vector2d place(in.number(fields[2], "x"), in.number(fields[3], "y"));
         const Eigen::Vector2d &known = result.places.emplace(dof.node, place).first->second;
         bool same = known == place;
         if (in_space)
         {
            const double z = in.number(fields[4], "z");
            same = same && result.z.emplace(dof.node, z).first->second == z;
         }
         in.require(same, "node ", dof.node, " is at ", place, ", and was at ", known,
                    " before", in_space ? " (or at another z)" : "");
         result.dofs.push_back(dof);
      });
   require(static_cast<Eigen::Index>(result.dofs.size()) == result.K.rows(), "file '", file,
           "' names ", result.dofs.size(), " rows, the matrix has ", result.K.rows());
   Entries entries(result);
   each_line(
      [&](const LineReader &in, const std::vector<std::string_view> &fields)
      {
         if (!is_word(fields[0])) { return; }
         const std::string word(fields[0]);
         const bool force = word == "force";
         if (word == "axisymmetric" && fields.size() == 1)
         {
            in.require(result.formulation != Formulation::space,
                       "'axisymmetric' stands in a file whose rows have x, y and z, must have "
                       "x and y only");
            result.formulation = Formulation::axisymmetric;
         }
         else if (word == "supports_left_out" && fields.size() == 1)
         {
            result.supports_left_out = true;
         }
         else if (word == "set" && fields.size() > 1)
         {
            NodalStiffness::Nodes &nodes = result.sets[upper_case(fields[1])];
            for (std::size_t k = 2; k < fields.size(); ++k)
            {
               nodes.push_back(in.integer(fields[k], "a node"));
               in.require(result.places.count(nodes.back()) == 1, "a set has node ",
                          nodes.back(), ", which has no row");
            }
         }
         else if ((word == "fixed" && fields.size() == 3) ||
                  ((force || word == "displacement") && fields.size() == 5))
         {
            const std::size_t first = fields.size() - (word == "fixed" ? 2 : 3);
            const NodeDof dof = dof_at(in, fields[first], fields[first + 1]);
            in.require(entries.has_row(dof), dof_name(dof), " has no row");
            if (word == "fixed") { entries.fix(dof); }
            else
            {
               entries.add(std::string(fields[1]),
                           force ? Control::force : Control::displacement, dof,
                           in.number(fields[4], "a value"));
            }
         }
         else if (word == "face" && is_face(fields.size() - 1))
         {
            NodalStiffness::Nodes face;
            for (std::size_t k = 1; k < fields.size(); ++k)
            {
               face.push_back(in.integer(fields[k], "a node"));
               in.require(result.places.count(face.back()) == 1, "a face has node ",
                          face.back(), ", which has no row");
            }
            result.faces.push_back(std::move(face));
         }
         else
         {
            in.require(false, "'", trimmed(in.line()),
                       "', must be axisymmetric, supports_left_out, set NAME nodes, face "
                       "nodes, fixed node "
                       "direction, force or displacement LOAD node direction value");
         }
      });
}

/// The description of the rows that write_npz() adds to its matrix.
void read_facts(const NumpyArrays &array, const std::string &file, NodalStiffness &result)
{
   const Eigen::Index size = result.K.rows();
   const auto fits = [&](const char *name, Eigen::Index rows)
   {
      require(rows == size, "file '", file, "': its array '", name, "' has ", rows,
              " rows, must have ", size, " as K");
   };
   const Eigen::MatrixXi dofs = array.whole("dofs", 2);
   const Eigen::MatrixXd places = array("places").matrix(file + "/places");
   fits("dofs", dofs.rows());
   fits("places", places.rows());
   const bool in_space = places.cols() == 3;
   require((places.cols() == 2 || in_space) && places.allFinite(), "file '", file,
           "': its array 'places' has ", places.cols(),
           " columns, must be x and y, or x, y and z, finite, of each row");
   if (in_space) { result.formulation = Formulation::space; }
   std::map<int, Eigen::Vector3d> known;
   for (Eigen::Index row = 0; row < size; ++row)
   {
      const NodeDof dof{dofs(row, 0), dofs(row, 1)};
      require(dof.direction >= 1 && dof.direction <= places.cols(), "file '", file, "': row ",
              row + 1, " is of direction ", dof.direction, ", must be ",
              in_space ? "1, 2 or 3" : "1 or 2");
      Eigen::Vector3d place(places(row, 0), places(row, 1), in_space ? places(row, 2) : 0);
      const Eigen::Vector3d &before = known.emplace(dof.node, place).first->second;
      require(before == place, "file '", file, "': node ", dof.node, " is at ",
              place_text(place, result.formulation), " in row ", row + 1, ", and was at ",
              place_text(before, result.formulation), " before");
      result.places[dof.node] = place.head(2);
      if (in_space) { result.z[dof.node] = place[2]; }
      result.dofs.push_back(dof);
   }
   if (array.has("faces"))
   {
      const NumpyArray given = array("faces");
      const Eigen::MatrixXi faces =
         array.whole("faces", given.shape.size() == 2 ? given.shape[1] : 1);
      for (Eigen::Index f = 0; f < faces.rows(); ++f)
      {
         NodalStiffness::Nodes face;
         for (int node : faces.row(f))
         {
            if (node < 0) { break; } // filled up
            require(result.places.count(node) == 1, "file '", file, "': face ", f, " has node ",
                    node, ", which has no row");
            face.push_back(node);
         }
         require(in_space && is_face(face.size()), "file '", file, "': face ", f, " has ",
                 face.size(), " nodes, must have ", nodes_of_faces, ", of a body in space");
         result.faces.push_back(std::move(face));
      }
   }
   if (array.has("axisymmetric")) { result.formulation = Formulation::axisymmetric; }
   result.supports_left_out = array.has("supports_left_out");
   if (array.has("fixed"))
   {
      const Eigen::MatrixXi fixed = array.whole("fixed", 1);
      result.fixed.assign(fixed.data(), fixed.data() + fixed.size());
   }
   for (const std::string &set : array.named("set"))
   {
      const Eigen::MatrixXi nodes = array.whole("set " + set, 1);
      for (int node : nodes.reshaped())
      {
         require(result.places.count(node) == 1, "file '", file, "': set ", set, " has node ",
                 node, ", which has no row");
      }
      result.sets[upper_case(set)].assign(nodes.data(), nodes.data() + nodes.size());
   }
   if (!array.has("loads")) { return; }
   const Eigen::MatrixXd loads = array("loads").matrix(file + "/loads");
   fits("loads", loads.rows());
   for (Eigen::Index k = 0; k < loads.cols(); ++k)
   {
      result.loads.push_back({"LOAD" + std::to_string(k + 1), Control::force, loads.col(k)});
   }
   for (const std::string &load : array.named("load"))
   {
      const Eigen::MatrixXi column = array.whole("load " + load, 1);
      require(column.size() == 1 && column(0) >= 0 && column(0) < loads.cols(), "file '", file,
              "': its array 'load ", load,
              "' must be the number of a column of its array 'loads', from 0");
      result.loads[column(0)].name = load;
   }
}

/// The first line that is not a comment of ABAQUS shows the format of an .mtx file.
enum class MtxForm
{
   matrix_market,
   user_element,
   sparse
};

MtxForm form_of(const std::string &file)
{
   LineReader in(file);
   while (in.next())
   {
      const std::string line = upper_case(trimmed(in.line()));
      if (line.rfind("%%MATRIXMARKET", 0) == 0) { return MtxForm::matrix_market; }
      if (line.rfind("*USER ELEMENT", 0) == 0) { return MtxForm::user_element; }
      if (line[0] != '*') { return MtxForm::sparse; }
   }
   throw InputError("file '" + file + "' is empty, must have a matrix");
}

/// The file with the places of nodes beside a matrix. ABAQUS calls the matrices of job.inp
/// job_STIF1.mtx, job_STIF2.mtx, … and job_MASS1.mtx, ….
std::string places_beside(const std::string &matrix, const char *ending)
{
   namespace fs = std::filesystem;
   const fs::path same = fs::path(matrix).replace_extension(ending);
   if (fs::exists(same) || fs::path(matrix).extension() != ".mtx") { return same.string(); }
   const std::string stem = same.stem().string();
   for (const char *word : {"_STIF", "_MASS"})
   {
      const std::size_t mark = upper_case(stem).rfind(word);
      const bool numbered = mark != std::string::npos && mark + 5 < stem.size() &&
                            std::all_of(stem.begin() + mark + 5, stem.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
      if (numbered) { return (same.parent_path() / (stem.substr(0, mark) + ending)).string(); }
   }
   return same.string();
}

/// InputError unless the file is there and its name ends with one of these.
void require_ending(const char *what, const std::string &file,
                    const std::vector<std::string> &endings)
{
   namespace fs = std::filesystem;
   const std::string ending = fs::path(file).extension().string();
   std::string all;
   for (const std::string &each : endings)
   {
      all += (all.empty() ? "" : each == endings.back() ? " or " : ", ") + each;
   }
   require(std::find(endings.begin(), endings.end(), ending) != endings.end(), what, " '", file,
           "' ends with '", ending, "', must end with ", all);
   require(fs::exists(file), "cannot read file '", file, "': there is no such file");
}

} // namespace

NodalStiffness read_stiffness(const std::string &matrix, const std::string &places)
{
   require_ending("stiffness", matrix, {".sti", ".mtx", ".npy", ".npz"});
   const std::string ending = std::filesystem::path(matrix).extension().string();
   const auto beside = [&](const char *of)
   { return places.empty() ? places_beside(matrix, of) : places; };
   const MtxForm form = ending == ".mtx" ? form_of(matrix) : MtxForm::matrix_market;
   NodalStiffness result;
   result.name = matrix;
   if (form == MtxForm::matrix_market && ending != ".sti")
   {
      if (ending == ".mtx") { result.K = read_matrix_market(matrix); }
      else
      {
         const NumpyArrays arrays(matrix);
         result.K = read_numpy(arrays, matrix);
         if (places.empty() && arrays.has("dofs"))
         {
            read_facts(arrays, matrix, result);
            result.validate();
            return result;
         }
      }
      read_dofs(beside(".dofs"), result);
   }
   else
   {
      const std::string deck = beside(".inp");
      InputDeck said = read_input_deck(deck, DeckUse::stiffness);
      take_nodes(said, result);
      if (ending == ".sti")
      {
         read_calculix(matrix, places_beside(matrix, ".dof"), said, result, Kind::stiffness);
      }
      else if (form == MtxForm::sparse)
      {
         read_abaqus_sparse(matrix, said, result, Kind::stiffness);
      }
      else { read_user_element(matrix, result); }
      // Forces are those of the whole circumference already.
      const bool wedge = ending == ".sti" && result.formulation == Formulation::axisymmetric;
      if (wedge) { result.K *= 180.0; }
      // Springs to the ground, or along an axis between nodes that are apart.
      for (const InputDeck::Element &element : said.elements)
      {
         if (element.type != "SPRING1" && element.type != "SPRING2") { continue; }
         result.supports_left_out = true;
         result.on_springs.insert(result.on_springs.end(), element.nodes.begin(),
                                  element.nodes.end());
      }
      add_cards(said.cards, deck, result);
      for (const char *load :
           {"DLOAD", "DSLOAD", "TEMPERATURE", "INITIAL CONDITIONS, TYPE=STRESS",
            "INITIAL CONDITIONS, TYPE=PLASTIC STRAIN", "INITIAL STRAIN INCREASE",
            "PRE-TENSION SECTION", "CONNECTOR LOAD", "CONNECTOR MOTION", "INERTIA RELIEF"})
      {
         require(said.keywords.count(load) == 0, "file '", deck, "': *", load,
                 " loads elements, which is not supported beside a matrix: give "
                 "forces as *CLOAD, or tractions on nodes of the surface after it is read");
      }
   }
   result.validate();
   return result;
}

void read_mass(NodalStiffness &stiffness, const std::string &file, const std::string &deck)
{
   require_ending("mass", file, {".mas", ".mtx", ".npy", ".npz"});
   const std::string ending = std::filesystem::path(file).extension().string();
   const MtxForm form = ending == ".mtx" ? form_of(file) : MtxForm::matrix_market;
   require(form != MtxForm::user_element, "mass '", file,
           "' is a user element, must be of *MATRIX GENERATE, MASS, or MatrixMarket");
   // 1. The matrix, with the rows of its file.
   NodalStiffness read;
   if (ending == ".mas" || form == MtxForm::sparse)
   {
      // Beside the mass with its name, or else beside the stiffness.
      const auto beside = [&](const char *its)
      {
         const std::string own = places_beside(file, its),
                           other = places_beside(stiffness.name, its);
         return !std::filesystem::exists(own) && std::filesystem::exists(other) ? other : own;
      };
      InputDeck said =
         read_input_deck(deck.empty() ? beside(".inp") : deck, DeckUse::stiffness);
      take_nodes(said, read);
      if (ending == ".mas") { read_calculix(file, beside(".dof"), said, read, Kind::mass); }
      else { read_abaqus_sparse(file, said, read, Kind::mass); }
      const bool wedge = ending == ".mas" && read.formulation == Formulation::axisymmetric;
      if (wedge) { read.K *= 180.0; }
   }
   else
   {
      read.K = ending == ".mtx" ? read_matrix_market(file, Kind::mass)
                                : read_numpy(NumpyArrays(file), file, Kind::mass);
      require(read.K.rows() == stiffness.K.rows(), "mass '", file, "' has ", read.K.rows(),
              " rows, must have ", stiffness.K.rows(), " as the stiffness '", stiffness.name,
              "'");
      read.dofs = stiffness.dofs;
   }
   // 2. The same entries in the rows of the stiffness.
   const std::map<NodeDof, int> rows = stiffness.rows();
   std::vector<int> row_of;
   for (const NodeDof &dof : read.dofs)
   {
      const auto found = rows.find(dof);
      require(found != rows.end(), "mass '", file, "' has ", dof_name(dof),
              ", which has no row in the stiffness '", stiffness.name,
              "', must be of the same body or bodies (read the mass before parts())");
      row_of.push_back(found->second);
   }
   std::vector<Eigen::Triplet<double>> entries;
   for (int row = 0; row < read.K.rows(); ++row)
   {
      for (Matrix::InnerIterator entry(read.K, row); entry; ++entry)
      {
         entries.emplace_back(row_of[row], row_of[entry.col()], entry.value());
      }
   }
   Matrix M(stiffness.K.rows(), stiffness.K.rows());
   M.setFromTriplets(entries.begin(), entries.end());
   // 3. A file that is cut off, or of another analysis, lacks rows.
   for (int row = 0; row < M.rows(); ++row)
   {
      require(M.coeff(row, row) != 0 || stiffness.K.coeff(row, row) == 0 ||
                 std::binary_search(stiffness.fixed.begin(), stiffness.fixed.end(), row),
              "mass '", file, "' has no entry for ", dof_name(stiffness.dofs[row]),
              ", which has a stiffness in '", stiffness.name,
              "', must have one for each such row: is the file complete? A node without mass "
              "needs a small one");
   }
   stiffness.M = std::move(M);
}

std::string matrix_of_deck(const std::string &deck)
{
   namespace fs = std::filesystem;
   const fs::path path(deck), folder = path.parent_path();
   const std::string job = path.stem().string();
   require(upper_case(path.extension().string()) == ".INP", "deck '", deck, "' ends with '",
           path.extension().string(), "', must end with .inp");
   require(fs::exists(path), "cannot read file '", deck, "'");
   std::vector<std::string> found;
   for (const std::string &name : {job + ".sti", job + ".mtx", job + "_STIF1.mtx"})
   {
      if (fs::exists(folder / name)) { found.push_back((folder / name).string()); }
   }
   require(found.size() == 1, "deck '", deck, "': there ",
           found.empty() ? "is no stiffness beside it, must be one of "
                         : "are " + std::to_string(found.size()) + " stiffnesses, ",
           found.empty() ? "'" + job + ".sti', '" + job + ".mtx' or '" + job + "_STIF1.mtx'"
                         : listed(found),
           found.empty() ? "" : ": the key or argument 'matrix' must name one");
   return found[0];
}

} // namespace cattaneo
