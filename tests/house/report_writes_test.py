"""The report writes and never reads: nothing in src/report opens a file or parses one. What it sets beside a result is
handed to it by src/store. Called by ctest."""
import re, unittest

import source

# Names of what opens, and of what parses; `read_table` as well as `Json::parse`.
READS = re.compile(r"(read|parse|load|open)|(read|parse)_\w+|\w*ifstream|fstream|filebuf|fopen|fread|mmap|toml|"
                   r"json_or_discarded|accept|directory_iterator|recursive_directory_iterator|file_size")
HEADERS = re.compile(r'<(fstream|filesystem|cstdio|toml\+\+/.*|matio\.h)>|"base/(block_reader|checkpoint|byte_tail)\.h"')


def reads(tokens):
    """(what, line) of every name that reads, and every header that serves to."""
    for kind, value, line in tokens:
        if kind == "name" and READS.fullmatch(value) or kind == "include" and HEADERS.fullmatch(value):
            yield value, line


class ReportWrites(unittest.TestCase):
    def test_nothing_in_report_reads(self):
        paths = source.files("src/report", kinds=("h", "cpp"))
        self.assertGreater(len(paths), 60)
        where = [f"{path}:{line}: {what}: the report only writes; a reader belongs in src/store"
                 for path in paths for what, line in reads(source.tokens(path))]
        self.assertFalse(where, "\n" + "\n".join(where))

    def test_readers_are_found(self):
        """What is in src/store would be told here."""
        for name in ("baseline_file", "certificate_file", "healthy_file", "logo_file", "result_json", "truth_file"):
            self.assertTrue(list(reads(source.tokens(f"src/store/{name}.cpp"))), name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
