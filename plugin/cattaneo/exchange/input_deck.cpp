#include <algorithm>
#include <cattaneo/exchange/input_deck.hpp>
#include <cattaneo/exchange/line_reader.hpp>
#include <cattaneo/exchange/outer_edges.hpp>
#include <filesystem>
#include <optional>
#include <set>

namespace cattaneo
{

namespace
{

/// "*NODE, NSET=ALL": its name and parameters, in capitals.
struct Keyword
{
   std::string name;
   std::map<std::string, std::string> parameters;

   std::string parameter(const std::string &key) const
   {
      const auto found = parameters.find(key);
      return found == parameters.end() ? "" : found->second;
   }
};

/// Corners of an element by its type in capitals: of CPE4, CAX8R, CPS3, of M3D9, which is what
/// Gmsh calls its quadrilaterals of 9 nodes, or of a truss T3D2, which is what programs write
/// that name lines; 0 of another.
std::size_t corners_of(const std::string &type)
{
   const std::string family = type.substr(0, 3);
   const std::size_t nodes = type.size() > 3 ? static_cast<std::size_t>(type[3] - '0') : 0;
   if (family == "T2D" || family == "T3D") { return 2; }
   if (type == "M3D9") { return 4; }
   if (family != "CPE" && family != "CPS" && family != "CAX") { return 0; }
   return nodes == 3 || nodes == 6 ? 3 : nodes == 4 || nodes == 8 ? 4 : 0;
}

class DeckReader
{
public:
   InputDeck deck;

   void read(const std::string &file, int depth);
   /// What can be said of all of it.
   void finish(const std::string &file);

private:
   void begin(LineReader &in, int depth);
   void begin_card(const LineReader &in);
   void data(LineReader &in);
   void node(const LineReader &in, const std::vector<std::string_view> &fields);
   void element(LineReader &in);
   void members(const LineReader &in, const std::vector<std::string_view> &fields);
   void surface(const LineReader &in, const std::vector<std::string_view> &fields);
   void load(const LineReader &in, const std::vector<std::string_view> &fields);
   void support(const LineReader &in, const std::vector<std::string_view> &fields);
   InputDeck::Nodes nodes_of(const LineReader &in, std::string_view name) const;
   /// Indices of an element, or of a set of them.
   std::vector<std::size_t> elements_of(const LineReader &in, std::string_view name) const;
   /// From GENERATE's first, last and step, of the numbers that there are.
   template <class Has>
   std::vector<int> generated(const LineReader &in, const std::vector<std::string_view> &fields,
                              Has has) const;

   Keyword keyword_;
   int parts_ = 0, loads_ = 0, displacements_ = 0;
   std::optional<Formulation> formulation_;
   std::map<int, std::size_t> index_; ///< of elements by their numbers
   /// A side of an element that a surface names, -1: all of its outer ones.
   struct Face
   {
      std::string surface, place;
      std::size_t element = 0;
      int side = -1;
   };
   std::vector<Face> faces_;
};

/// A set that is named or listed several times has each member once, in the order of the file.
template <class Member>
void drop_repeated(std::vector<Member> &members)
{
   std::set<Member> seen;
   const auto again = [&](Member member) { return !seen.insert(member).second; };
   members.erase(std::remove_if(members.begin(), members.end(), again), members.end());
}

/// "instance.set" and "set", in capitals.
std::string plain_name(std::string_view name)
{
   return upper_case(name.substr(std::min(name.rfind('.') + 1, name.size())));
}

std::string place(const LineReader &in)
{
   return "file '" + in.file() + "', line " + std::to_string(in.line_number());
}

bool is_number(std::string_view field)
{
   return !field.empty() && std::isdigit(static_cast<unsigned char>(field[0]));
}

void DeckReader::read(const std::string &file, int depth)
{
   LineReader in(file);
   keyword_ = {};
   while (in.next())
   {
      const std::string_view line = trimmed(in.line());
      if (upper_case(line) == "** AXISYMMETRIC")
      {
         deck.formulation = Formulation::axisymmetric;
      }
      if (line.substr(0, 2) == "**") { continue; }
      if (line[0] == '*') { begin(in, depth); }
      else { data(in); }
   }
}

void DeckReader::begin(LineReader &in, int depth)
{
   keyword_ = {};
   std::string file;
   for (;;)
   {
      for (const std::string_view field : in.fields())
      {
         if (field.substr(0, 1) == "*")
         {
            keyword_.name = upper_case(field.substr(1));
            continue;
         }
         const std::size_t equals = std::min(field.find('='), field.size());
         std::string_view value = trimmed(field.substr(std::min(equals + 1, field.size())));
         if (value.size() > 1 && value.front() == '"')
         {
            value = value.substr(1, value.size() - 2);
         }
         const std::string key = upper_case(trimmed(field.substr(0, equals)));
         keyword_.parameters[key] = upper_case(value);
         if (key == "INPUT") { file = value; }
      }
      if (trimmed(in.line()).back() != ',' || !in.next()) { break; } // goes on in the next line
   }
   const std::string &name = keyword_.name;
   if (name == "INCLUDE")
   {
      in.require(!file.empty(), "*INCLUDE has no INPUT, must name a file");
      in.require(depth < 10, "files include each other more than 10 deep, must not");
      read((std::filesystem::path(in.file()).parent_path() / file).string(), depth + 1);
      keyword_ = {};
   }
   begin_card(in);
}

void DeckReader::begin_card(const LineReader &in)
{
   const std::string &name = keyword_.name;
   deck.keywords.insert(name);
   if (name == "INITIAL CONDITIONS")
   {
      deck.keywords.insert(name + ", TYPE=" + keyword_.parameters["TYPE"]);
   }
   in.require(name != "TRANSFORM", "*TRANSFORM turns directions of nodes, must be left out: "
                                   "everything is read in x and y");
   static const std::set<std::string> couplings = {"EQUATION",
                                                   "MPC",
                                                   "RIGID BODY",
                                                   "COUPLING",
                                                   "KINEMATIC",
                                                   "DISTRIBUTING",
                                                   "DISTRIBUTING COUPLING",
                                                   "KINEMATIC COUPLING",
                                                   "TIE",
                                                   "PRE-TENSION SECTION",
                                                   "CONTACT PAIR",
                                                   "CYCLIC SYMMETRY MODEL"};
   in.require(couplings.count(name) == 0, "*", name,
              " makes nodes depend on others, whose rows "
              "are not their own then, must be left out");
   parts_ += name == "PART";
   in.require(parts_ < 2, "a second *PART begins, there must be one: node numbers of several "
                          "are not told apart");
   if (name == "SOLID SECTION")
   {
      ++deck.sections;
      const auto set = deck.element_sets.find(plain_name(keyword_.parameter("ELSET")));
      if (set == deck.element_sets.end()) { return; }
      for (std::size_t e : set->second) { deck.elements[e].section = deck.sections; }
   }
   const std::string elements = keyword_.parameter("ELSET");
   if (name == "NSET" && !elements.empty())
   {
      for (std::size_t e : elements_of(in, elements))
      {
         for (int node : deck.elements[e].nodes)
         {
            deck.node_sets[keyword_.parameter("NSET")].push_back(node);
         }
      }
   }
   if (name == "CLOAD")
   {
      deck.cards.push_back({"CLOAD" + std::to_string(++loads_), Control::force, {}});
   }
   if (name == "BOUNDARY")
   {
      deck.cards.push_back(
         {"BOUNDARY" + std::to_string(++displacements_), Control::displacement, {}});
   }
}

void DeckReader::data(LineReader &in)
{
   const std::string &name = keyword_.name;
   const std::vector<std::string_view> fields = in.fields();
   if (fields.empty()) { return; } // a comma alone
   if (name == "NODE") { node(in, fields); }
   else if (name == "ELEMENT") { element(in); }
   else if (name == "NSET" || name == "ELSET") { members(in, fields); }
   else if (name == "SURFACE") { surface(in, fields); }
   else if (name == "CLOAD") { load(in, fields); }
   else if (name == "BOUNDARY") { support(in, fields); }
   else if (name == "INSTANCE")
   {
      in.require(false, "an instance is moved, must be where its part is");
   }
   else if (name == "SOLID SECTION" && !fields[0].empty())
   {
      const double thickness = in.number(fields[0], "the thickness of *SOLID SECTION");
      in.require(thickness == 1, "the thickness of *SOLID SECTION is ", thickness,
                 ", must be 1: everything is per unit thickness");
   }
}

void DeckReader::node(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*NODE has ", fields.size(),
              " fields, must have a number and two coordinates");
   const int number = in.integer(fields[0], "the number of a node");
   in.require(number > 0, "the number of a node is ", number, ", must be positive");
   const Eigen::Vector2d place(in.number(fields[1], "x of a node"),
                               in.number(fields[2], "y of a node"));
   const double z =
      fields.size() > 3 && !fields[3].empty() ? in.number(fields[3], "z of a node") : 0;
   in.require(z == 0, "node ", number, " is at z = ", z, ", must be in the plane z = 0");
   in.require(deck.places.emplace(number, place).second, "node ", number,
              " is there a second time, must be there once");
   const std::string set = keyword_.parameter("NSET");
   if (!set.empty()) { deck.node_sets[set].push_back(number); }
}

void DeckReader::element(LineReader &in)
{
   InputDeck::Element made;
   made.type = keyword_.parameter("TYPE");
   made.place = place(in);
   made.corners = corners_of(made.type);
   in.add_integers(made.nodes, "a number of *ELEMENT");
   while (trimmed(in.line()).back() == ',' && in.next())
   {
      in.add_integers(made.nodes, "a number of *ELEMENT");
   }
   if (made.nodes.empty()) { return; }
   made.number = made.nodes.front();
   made.nodes.erase(made.nodes.begin());
   in.require(index_.emplace(made.number, deck.elements.size()).second, "element ", made.number,
              " is there a second time, must be there once");
   const std::string set = keyword_.parameter("ELSET");
   if (!set.empty()) { deck.element_sets[set].push_back(deck.elements.size()); }
   in.require(made.corners != 2 || made.nodes.size() > 1, "element ", made.number, " is a ",
              made.type, " of one node, must have two or three");
   if (made.corners > 2)
   {
      const auto count = static_cast<std::size_t>(made.type[3] - '0');
      in.require(made.nodes.size() == count, "element ", made.number, " is a ", made.type,
                 " of ", made.nodes.size(), " nodes, must have ", count);
      const Formulation formulation =
         made.type[1] == 'A' ? Formulation::axisymmetric : Formulation::plane;
      in.require(!formulation_ || *formulation_ == formulation,
                 "there are plane and axisymmetric elements, must be of one kind");
      formulation_ = deck.formulation = formulation;
      for (int node : made.nodes)
      {
         in.require(deck.places.count(node) == 1, "element ", made.number, " has node ", node,
                    ", which *NODE does not name, it must be there before");
      }
   }
   deck.elements.push_back(std::move(made));
}

InputDeck::Nodes DeckReader::nodes_of(const LineReader &in, std::string_view name) const
{
   if (is_number(name)) { return {in.integer(name, "a node")}; }
   const auto found = deck.node_sets.find(plain_name(name));
   if (found != deck.node_sets.end()) { return found->second; }
   const auto of_elements = deck.element_sets.find(plain_name(name));
   in.require(of_elements != deck.element_sets.end(), "there is no set '", name,
              "' before this line");
   InputDeck::Nodes nodes;
   for (std::size_t e : of_elements->second)
   {
      nodes.insert(nodes.end(), deck.elements[e].nodes.begin(), deck.elements[e].nodes.end());
   }
   return nodes;
}

std::vector<std::size_t> DeckReader::elements_of(const LineReader &in,
                                                 std::string_view name) const
{
   if (is_number(name))
   {
      const int number = in.integer(name, "an element");
      const auto found = index_.find(number);
      in.require(found != index_.end(), "there is no element ", number, " before this line");
      return {found->second};
   }
   const auto found = deck.element_sets.find(plain_name(name));
   in.require(found != deck.element_sets.end(), "there is no element set '", name,
              "' before this line");
   return found->second;
}

template <class Has>
std::vector<int> DeckReader::generated(const LineReader &in,
                                       const std::vector<std::string_view> &fields,
                                       Has has) const
{
   in.require(fields.size() >= 2, "GENERATE has ", fields.size(),
              " numbers, must have the first, the last and a step");
   const int first = in.integer(fields[0], "the first number"),
             last = in.integer(fields[1], "the last number"),
             step = fields.size() > 2 ? in.integer(fields[2], "the step") : 1;
   in.require(step > 0 && first > 0 && last >= first && has(first) && has(last),
              "GENERATE from ", first, " to ", last, " by ", step, ", must be between ",
              keyword_.name == "NSET" ? "nodes" : "elements", " that are there, upwards");
   std::vector<int> numbers;
   for (long k = first; k <= last; k += step)
   {
      if (has(static_cast<int>(k))) { numbers.push_back(static_cast<int>(k)); }
   }
   return numbers;
}

void DeckReader::members(const LineReader &in, const std::vector<std::string_view> &fields)
{
   const std::string &kind = keyword_.name, set = keyword_.parameter(kind);
   in.require(!set.empty(), "*", kind, " has no name, must have ", kind, "=name");
   const bool list = keyword_.parameters.count("GENERATE") == 0;
   if (kind == "NSET")
   {
      const auto has = [&](int node) { return deck.places.count(node) == 1; };
      InputDeck::Nodes some;
      if (!list) { some = generated(in, fields, has); }
      for (std::size_t k = 0; k < fields.size() && list; ++k)
      {
         const InputDeck::Nodes more = nodes_of(in, fields[k]);
         some.insert(some.end(), more.begin(), more.end());
      }
      InputDeck::Nodes &nodes = deck.node_sets[set];
      nodes.insert(nodes.end(), some.begin(), some.end());
      return;
   }
   const auto has = [&](int element) { return index_.count(element) == 1; };
   std::vector<std::size_t> some;
   if (!list)
   {
      for (int e : generated(in, fields, has)) { some.push_back(index_.at(e)); }
   }
   for (std::size_t k = 0; k < fields.size() && list; ++k)
   {
      const std::vector<std::size_t> more = elements_of(in, fields[k]);
      some.insert(some.end(), more.begin(), more.end());
   }
   std::vector<std::size_t> &elements = deck.element_sets[set];
   elements.insert(elements.end(), some.begin(), some.end());
}

void DeckReader::surface(const LineReader &in, const std::vector<std::string_view> &fields)
{
   const std::string type = keyword_.parameter("TYPE"), name = keyword_.parameter("NAME");
   if (type == "NODE")
   {
      for (int node : nodes_of(in, fields[0])) { deck.node_sets[name].push_back(node); }
   }
   // Analytical ones and combinations are no parts of a body.
   if ((type != "ELEMENT" && !type.empty()) || !keyword_.parameter("COMBINE").empty())
   {
      return;
   }
   int side = -1;
   if (fields.size() > 1)
   {
      const std::string label = upper_case(fields[1]);
      in.require(label.size() == 2 && label[0] == 'S' && label[1] >= '1' && label[1] <= '4',
                 "face '", fields[1], "' of surface '", name, "', must be S1 to S4");
      side = label[1] - '1';
   }
   for (std::size_t e : elements_of(in, fields[0]))
   {
      faces_.push_back({name, place(in), e, side});
   }
}

void DeckReader::finish(const std::string &file)
{
   std::vector<InputDeck::Nodes> plane;
   std::vector<int> numbers;
   for (const InputDeck::Element &element : deck.elements)
   {
      if (element.corners < 3) { continue; }
      plane.push_back(element.nodes);
      numbers.push_back(element.number);
   }
   try
   {
      deck.edges = outer_edges(plane, deck.places, numbers);
   }
   catch (const InputError &error)
   {
      throw InputError("file '" + file + "': " + error.what());
   }
   std::map<std::pair<int, int>, const InputDeck::Nodes *> outer;
   for (const InputDeck::Nodes &edge : deck.edges)
   {
      outer[std::minmax(edge.front(), edge.back())] = &edge;
   }
   for (const Face &face : faces_)
   {
      const InputDeck::Element &element = deck.elements[face.element];
      std::vector<InputDeck::Nodes> &edges = deck.surfaces[face.surface];
      const auto corners = static_cast<int>(element.corners);
      require(corners > 2 && face.side < corners, face.place, ": surface '", face.surface,
              "' has face S", face.side + 1, " of element ", element.number, ", a ",
              element.type, ", which has none");
      for (int k = 0; k < corners; ++k)
      {
         if (face.side >= 0 && face.side != k) { continue; }
         const auto found =
            outer.find(std::minmax(element.nodes[k], element.nodes[(k + 1) % corners]));
         require(face.side < 0 || found != outer.end(), face.place, ": face S", k + 1,
                 " of element ", element.number, " of surface '", face.surface,
                 "' is inside of the body, must be on its boundary");
         if (found != outer.end()) { edges.push_back(*found->second); }
      }
   }
   for (auto &[name, nodes] : deck.node_sets) { drop_repeated(nodes); }
   for (auto &[name, elements] : deck.element_sets) { drop_repeated(elements); }
   for (auto &[name, edges] : deck.surfaces) { drop_repeated(edges); }
}

void DeckReader::load(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 3, "*CLOAD has ", fields.size(),
              " fields, must have a node or set, a direction and a force");
   const int direction = in.integer(fields[1], "the direction of a force");
   const double force = in.number(fields[2], "a force");
   for (int node : nodes_of(in, fields[0]))
   {
      deck.cards.back().values.push_back({{node, direction}, force});
   }
}

void DeckReader::support(const LineReader &in, const std::vector<std::string_view> &fields)
{
   in.require(fields.size() >= 2, "*BOUNDARY has ", fields.size(),
              " fields, must have a node or set and a direction");
   static const std::map<std::string, std::array<int, 2>> words = {
      {"ENCASTRE", {1, 2}}, {"PINNED", {1, 2}}, {"XSYMM", {1, 1}}, {"YSYMM", {2, 2}}};
   const auto word = words.find(upper_case(fields[1]));
   std::array<int, 2> directions{};
   double value = 0;
   if (word != words.end()) { directions = word->second; }
   else
   {
      directions.fill(in.integer(fields[1], "the direction of a support"));
      if (fields.size() > 2 && !fields[2].empty())
      {
         directions[1] = in.integer(fields[2], "the last direction of a support");
      }
      if (fields.size() > 3) { value = in.number(fields[3], "a displacement"); }
   }
   in.require(directions[0] >= 1, "the direction of a support is ", directions[0],
              ", must be at least 1");
   for (int node : nodes_of(in, fields[0]))
   {
      // Across the plane nothing moves.
      for (int d = directions[0]; d <= std::min(directions[1], 2); ++d)
      {
         deck.cards.back().values.push_back({{node, d}, value});
      }
   }
}

} // namespace

InputDeck read_input_deck(const std::string &file)
{
   DeckReader reader;
   reader.read(file, 0);
   require(!reader.deck.places.empty(), "file '", file, "': there is no *NODE, must be");
   reader.finish(file);
   return std::move(reader.deck);
}

} // namespace cattaneo
