#include <algorithm>
#include <array>
#include <cattaneo/exchange/numpy_file.hpp>
#include <cattaneo/exchange/write_stiffness.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/whole_file.hpp>
#include <cstdint>
#include <cstring>

namespace cattaneo
{

using Eigen::Index;

namespace
{

/// Little-endian, as zip and NumPy's default have them.
template <class Number>
void append(std::string &to, Number value)
{
   to.append(reinterpret_cast<const char *>(&value), sizeof value);
}

/// A number at a place of a file; InputError beyond its end.
template <class Number>
Number at(const std::string &content, std::size_t place, const std::string &name)
{
   Number value;
   require(place <= content.size() && sizeof value <= content.size() - place, "file '", name,
           "' is cut short at byte ", content.size());
   std::memcpy(&value, content.data() + place, sizeof value);
   return value;
}

std::string part(const std::string &content, std::size_t from, std::size_t size,
                 const std::string &name)
{
   require(from <= content.size() && size <= content.size() - from, "file '", name,
           "' is cut short at byte ", content.size());
   return content.substr(from, size);
}

template <class Number>
void take(const std::string &content, std::size_t from, std::vector<double> &values)
{
   for (std::size_t k = 0; k < values.size(); ++k)
   {
      Number value;
      std::memcpy(&value, content.data() + from + k * sizeof value, sizeof value);
      values[k] = static_cast<double>(value);
   }
}

std::uint32_t checksum(const std::string &content)
{
   static const auto table = []
   {
      std::array<std::uint32_t, 256> made{};
      for (std::uint32_t byte = 0; byte < made.size(); ++byte)
      {
         std::uint32_t c = byte;
         for (int bit = 0; bit < 8; ++bit) { c = c & 1 ? 0xEDB88320U ^ (c >> 1) : c >> 1; }
         made[byte] = c;
      }
      return made;
   }();
   std::uint32_t crc = 0xFFFFFFFFU;
   for (char c : content)
   {
      crc = table[(crc ^ static_cast<unsigned char>(c)) & 0xFF] ^ (crc >> 8);
   }
   return crc ^ 0xFFFFFFFFU;
}

/// An .npy file of a matrix, by columns.
std::string numpy_text(const Eigen::MatrixXd &M)
{
   std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (" +
                        std::to_string(M.rows()) + ", " + std::to_string(M.cols()) + "), }";
   header.append(63 - (10 + header.size()) % 64, ' ').push_back('\n');
   std::string text = "\x93NUMPY\x01";
   text.push_back('\0');
   append(text, static_cast<std::uint16_t>(header.size()));
   text += header;
   text.append(reinterpret_cast<const char *>(M.data()), M.size() * sizeof(double));
   return text;
}

/// The value of 'key' in the header.
std::string entry(const std::string &header, const std::string &key, const std::string &name)
{
   const std::size_t found = header.find("'" + key + "':");
   require(found != std::string::npos, "file '", name,
           "' is no NumPy array: its header has no ", key);
   const std::size_t from = header.find_first_not_of(' ', found + key.size() + 3);
   const std::size_t end = header.find_first_of(key == "shape" ? ")" : ",}", from);
   return from < end && end != std::string::npos ? header.substr(from, end - from) : "";
}

constexpr std::uint32_t local_mark = 0x04034b50, central_mark = 0x02014b50,
                        end_mark = 0x06054b50;

} // namespace

Eigen::MatrixXd NumpyArray::matrix(const std::string &name) const
{
   require(shape.size() == 2, "file '", name, "' has ", shape.size(),
           " dimensions, must have two");
   using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
   if (by_columns)
   {
      return Eigen::Map<const Eigen::MatrixXd>(values.data(), shape[0], shape[1]);
   }
   return Eigen::Map<const RowMajor>(values.data(), shape[0], shape[1]);
}

NumpyArray numpy_array(const std::string &content, const std::string &name)
{
   require(content.compare(0, 6, "\x93NUMPY") == 0, "file '", name, "' is no NumPy array");
   const auto version = at<std::uint8_t>(content, 6, name);
   const std::size_t begin = version == 1 ? 10 : 12;
   const std::size_t length =
      version == 1 ? at<std::uint16_t>(content, 8, name) : at<std::uint32_t>(content, 8, name);
   const std::string header = part(content, begin, length, name);
   const std::string kind = entry(header, "descr", name), shape = entry(header, "shape", name);
   NumpyArray array;
   array.by_columns = entry(header, "fortran_order", name) == "True";
   const std::size_t data = begin + length, bytes = content.size() - data;
   const std::size_t size = kind == "'<f8'" || kind == "'<i8'"   ? 8
                            : kind == "'<f4'" || kind == "'<i4'" ? 4
                                                                 : 0;
   require(size > 0, "file '", name, "' has numbers of type ", kind,
           ", must be float64, float32, int64 or int32");
   for (const char *c = shape.c_str() + 1; !shape.empty() && *c;)
   {
      char *end = nullptr;
      const long long extent = std::strtoll(c, &end, 10);
      if (end == c) { break; }
      array.shape.push_back(extent);
      c = *end == ',' ? end + 1 : end;
   }
   const bool empty = std::count(array.shape.begin(), array.shape.end(), 0) > 0;
   std::size_t count = empty ? 0 : 1;
   for (const auto extent : array.shape)
   {
      require(extent >= 0 && (empty || count <= bytes / size / extent), "file '", name,
              "' is cut short: it has ", bytes, " bytes for a shape ", shape, ")");
      count *= extent;
   }
   require(count * size == bytes, "file '", name, "' has ", bytes, " bytes, must have ",
           count * size, " for its ", count, " numbers");
   array.values.resize(count);
   if (kind == "'<f8'") { take<double>(content, data, array.values); }
   else if (kind == "'<f4'") { take<float>(content, data, array.values); }
   else if (kind == "'<i8'") { take<std::int64_t>(content, data, array.values); }
   else { take<std::int32_t>(content, data, array.values); }
   return array;
}

std::map<std::string, std::string> stored_files(const std::string &archive,
                                                const std::string &name)
{
   std::string mark;
   append(mark, end_mark);
   const std::size_t end = archive.rfind(mark);
   require(end != std::string::npos, "file '", name,
           "' is no complete zip archive: it has no directory at its end");
   const auto count = at<std::uint16_t>(archive, end + 10, name);
   std::size_t place = at<std::uint32_t>(archive, end + 16, name);
   std::map<std::string, std::string> files;
   for (int k = 0; k < count; ++k)
   {
      require(at<std::uint32_t>(archive, place, name) == central_mark, "file '", name,
              "' is no valid zip archive: entry ", k,
              " of its directory does not begin with the mark of an entry");
      const auto method = at<std::uint16_t>(archive, place + 10, name);
      const auto crc = at<std::uint32_t>(archive, place + 16, name);
      const auto size = at<std::uint32_t>(archive, place + 24, name);
      const auto length = at<std::uint16_t>(archive, place + 28, name),
                 extra = at<std::uint16_t>(archive, place + 30, name),
                 comment = at<std::uint16_t>(archive, place + 32, name);
      const std::size_t local = at<std::uint32_t>(archive, place + 42, name);
      const std::string called = part(archive, place + 46, length, name);
      require(method == 0, "file '", name, "': its array '", called,
              "' is compressed, must not be: np.savez, or save_npz(…, compressed=False)");
      require(at<std::uint32_t>(archive, local, name) == local_mark, "file '", name,
              "': its array '", called,
              "' is not at the place that the directory of the archive states");
      const std::size_t data = local + 30 + at<std::uint16_t>(archive, local + 26, name) +
                               at<std::uint16_t>(archive, local + 28, name);
      const std::string content = part(archive, data, size, name);
      require(checksum(content) == crc, "file '", name, "': its array '", called,
              "' is damaged: its checksum is wrong");
      files[called] = content;
      place += 46 + length + extra + comment;
   }
   return files;
}

void write_npz(const std::string &file, const std::map<std::string, Eigen::MatrixXd> &arrays)
{
   std::string text, directory;
   for (const auto &[name, M] : arrays)
   {
      const std::string called = name + ".npy", content = numpy_text(M);
      require(content.size() < 0xFFFFFFFFU && text.size() < 0xFFFFFFFFU - content.size(),
              "file '", file, "': array ", name, " has ", content.size(),
              " bytes, a zip archive must have less than 4 GiB");
      // Version, no flags, stored, 1980-01-01, checksum and sizes, length of the name.
      std::string common;
      for (int field : {20, 0, 0, 0, 33}) { append(common, static_cast<std::uint16_t>(field)); }
      append(common, checksum(content));
      append(common, static_cast<std::uint32_t>(content.size())); // as stored, and unpacked
      append(common, static_cast<std::uint32_t>(content.size()));
      append(common, static_cast<std::uint16_t>(called.size()));
      append(common, std::uint16_t(0));
      append(directory, central_mark);
      append(directory, std::uint16_t(20));
      directory += common;
      directory.append(10, '\0'); // no comment, disk 0, attributes
      append(directory, static_cast<std::uint32_t>(text.size()));
      directory += called;
      append(text, local_mark);
      text += common + called + content;
   }
   const std::size_t begin = text.size();
   text += directory;
   append(text, end_mark);
   append(text, std::uint32_t(0));                          // disks
   append(text, static_cast<std::uint16_t>(arrays.size())); // on this disk, and in all
   append(text, static_cast<std::uint16_t>(arrays.size()));
   append(text, static_cast<std::uint32_t>(directory.size()));
   append(text, static_cast<std::uint32_t>(begin));
   append(text, std::uint16_t(0)); // no comment
   write_whole(file, text);
}

} // namespace cattaneo
