#pragma once

#include <cattaneo/input_error.hpp>
#include <fstream>
#include <functional>
#include <string>

namespace cattaneo
{

/// A table cannot be continued, because the disk is full or gone. Rows that were written stay.
class WriteError : public InputError
{
public:
   using InputError::InputError;
};

/** A table that is written row by row, a line each, and keeps none of them in memory. When
    add() returns the operating system has the row, so that it is kept even if the program ends.
    The first column is a time that does not decrease. */
class StreamedFile
{
public:
   /// A new file, in place of an old one of that name. `header`: its first line, without the
   /// end of line. InputError if the file cannot be written.
   StreamedFile(const std::string &file, const std::string &header);
   /** Continues a file of an earlier run: lines later than `time`, and an incomplete last line,
       are dropped. A new file if there is none. InputError if it has another header or cannot
       be written.
       @param check called with the last line that stays, before anything is dropped; it throws
       if this is not the right file */
   StreamedFile(const std::string &file, const std::string &header, double time,
                const std::function<void(const std::string &)> &check = {});

   /// Appends complete lines, with their ends. WriteError if they cannot be written.
   void add(const std::string &lines);

private:
   void open();

   std::string file_;
   std::ofstream out_;
};

} // namespace cattaneo
