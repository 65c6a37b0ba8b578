# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The sources of the wheel keep to what every compiler of its platforms takes, as far as that can be
read: CONTRIBUTING.md has the list. Argument: the folder of the sources."""
import re
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop())
FOLDERS = {"Filters/Core": SOURCE / "Filters", "Filters/Run": SOURCE / "Filters",
           "Python/Extension": SOURCE / "Python/Extension"}

#: Names of the standard library, and the header that declares them
HEADERS = {
    "algorithm": r"(?:sort|stable_sort|min|max|minmax|clamp|fill|fill_n|copy|copy_n|copy_if|transform|any_of|"
                 r"all_of|none_of|count|count_if|find|find_if|lower_bound|upper_bound|equal_range|nth_element|"
                 r"unique|partition|reverse|rotate|remove_if|min_element|max_element|binary_search|"
                 r"swap_ranges|replace|equal|is_sorted|push_heap|pop_heap|make_heap|set_intersection|merge)(?=\()",
    "array": r"array\b",
    "atomic": r"atomic\b",
    "chrono": r"chrono\b",
    "cmath": r"(?:sqrt|cbrt|exp|expm1|log|log2|log10|log1p|pow|floor|ceil|round|lround|llround|cos|sin|tan|acos|"
             r"asin|atan|atan2|cosh|sinh|tanh|fabs|fmod|isnan|isinf|isfinite|hypot|copysign|erf|ldexp|frexp|"
             r"nextafter|ilogb|tgamma|lgamma)(?=\()",
    "condition_variable": r"condition_variable\b",
    "cstdint": r"u?int(?:8|16|32|64|ptr)_t\b",
    "cstring": r"(?:memcpy|memset|memcmp|memmove|strlen|strcmp)(?=\()",
    "deque": r"deque\b",
    "exception": r"(?:exception_ptr|current_exception|rethrow_exception)\b",
    "functional": r"(?:function|ref|cref|less|greater|plus|hash)\b",
    "future": r"(?:future|promise|async)\b",
    "iterator": r"(?:back_inserter|inserter|istream_iterator|make_move_iterator)\b",
    "limits": r"numeric_limits\b",
    "map": r"(?:multi)?map\b",
    "memory": r"(?:unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared|addressof)\b",
    "mutex": r"(?:mutex|lock_guard|unique_lock|scoped_lock|once_flag|call_once)\b",
    "new": r"bad_alloc\b",
    "numeric": r"(?:accumulate|iota|inner_product|partial_sum|adjacent_difference|gcd|lcm)(?=\()",
    "optional": r"(?:optional|nullopt)\b",
    "queue": r"(?:priority_)?queue\b",
    "random": r"(?:mt19937|mt19937_64|random_device|\w+_distribution)\b",
    "set": r"(?:multi)?set\b",
    "sstream": r"[io]?stringstream\b",
    "stdexcept": r"(?:runtime_error|logic_error|invalid_argument|out_of_range|length_error|domain_error)\b",
    "string": r"(?:string|to_string|stoi|stod)\b",
    "string_view": r"string_view\b",
    "system_error": r"system_error\b",
    "thread": r"(?:thread|this_thread)\b",
    "tuple": r"(?:tuple|make_tuple|tie)\b",
    "type_traits": r"(?:is_\w+_v|enable_if_t|conditional_t|decay_t|remove_\w+_t|invoke_result_t|"
                   r"integral_constant|true_type|false_type|underlying_type_t)\b",
    "unordered_map": r"unordered_map\b",
    "unordered_set": r"unordered_set\b",
    "utility": r"(?:pair|make_pair|move|swap|exchange|forward|as_const|index_sequence)\b",
    "variant": r"(?:variant|visit|holds_alternative)\b",
    "vector": r"vector\b",
}
USED = {header: re.compile(r"\bstd::" + names) for header, names in HEADERS.items()}

#: Found outside of a section for one compiler: what it is, and what stands in its place
REFUSED = {
    r"#\s*include\s*<(?:unistd|pthread|dlfcn|strings|alloca|immintrin|x86intrin|sys/\w+|bits/[\w+.]+)(?:\.h)?>":
        "a header of POSIX, of one processor or of one library: use the standard library",
    r"#\s*include\s*<(?:charconv|filesystem|execution|memory_resource)>":
        "a header that the oldest compiler of ParaView's images (GCC 7) has not",
    r"\bM_(?:PI|E|SQRT2|LN2|PI_2)\w*\b": "a constant that <cmath> has on some systems only: EIGEN_PI",
    r"\b(?:ssize_t|uint|ulong|ushort|__int128|__float128)\b": "a type of some compilers: those of <cstdint>",
    r"\b(?:fork|mmap|munmap|sysconf|setenv|getenv_s|secure_getenv|strcasecmp|strdup|drand48|rand_r|alloca|"
    r"usleep|gettimeofday|localtime_r|posix_\w+|pthread_\w+|sched_\w+)\s*\(": "a function of POSIX",
    r"__builtin_\w+|__attribute__|\btypeof\b|__typeof__|\[\[gnu::|#\s*pragma (?:GCC|clang)":
        "an extension of GCC and clang",
    r"(?<![\w.>])(?:and|or|not|xor|bitand|bitor|compl)(?=[\s(])": "a word for an operator",
    r"\bstd::(?:cyl_\w+|sph_\w+|assoc_\w+|(?:comp_)?ellint_\w+|expint|legendre|hermite|laguerre|beta|"
    r"riemann_zeta)\s*\(": "a special function, which libc++ has not",
    r"[{,]\s*\.\w+\s*=[^=]": "a designated initialiser, which is C++20",
}


def without_texts(code):
    """The code with comments and literals emptied, on the same lines."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.DOTALL)

    def emptied(match):
        text = match.group()
        if text[0] in "\"'":
            return text[0] * 2
        return "\n" * text.count("\n")
    # Names of included files are no literals
    lines = code.split("\n")
    kept = {i: line for i, line in enumerate(lines) if re.match(r"\s*#\s*include\b", line)}
    lines = pattern.sub(emptied, code).split("\n")
    return "\n".join(kept.get(i, line) for i, line in enumerate(lines))


def for_every_compiler(code):
    """The code without sections that only one compiler sees: from #if with its name to #else."""
    of_one = re.compile(r"__GNUC__|__clang__|_MSC_VER|_WIN32")
    lines, depth, hidden = [], 0, None
    for line in code.split("\n"):
        directive = re.match(r"\s*#\s*(if|ifdef|ifndef|elif|else|endif)\b(.*)", line)
        if directive:
            word, condition = directive.groups()
            if word.startswith("if"):
                depth += 1
                if hidden is None and of_one.search(condition):
                    hidden = depth
            elif word in ("else", "elif") and hidden in (None, depth):
                hidden = depth if word == "elif" and of_one.search(condition) else None
            elif word == "endif":
                if hidden == depth:
                    hidden = None
                depth -= 1
        lines.append("" if hidden is not None else line)
    return "\n".join(lines)


def texts_of(code):
    """The bytes of each text; literals beside each other are one text."""
    literal = r'"(?:\\.|[^"\\\n])*"'
    for match in re.finditer(rf"{literal}(?:\s*{literal})*", code):
        yield match.start(), sum(len(part.encode()) - 2 for part in re.findall(literal, match.group()))


def read():
    return {path: path.read_text(encoding="utf-8") for folder in FOLDERS
            for path in sorted((SOURCE / folder).rglob("*")) if path.suffix in (".h", ".cxx")}


class Sources(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.read = read()
        cls.code = {path: without_texts(text) for path, text in cls.read.items()}

    def report(self, path, at, code, what):
        line = code.count("\n", 0, at) + 1
        self.fail(f"{path.relative_to(SOURCE)}:{line}: {what}")

    def test_there_are_sources(self):
        self.assertGreater(len(self.read), 300)

    def test_nothing_is_of_one_compiler_or_system_alone(self):
        for path, code in self.code.items():
            seen = for_every_compiler(code)
            for pattern, what in REFUSED.items():
                found = re.search(pattern, seen)
                if found:
                    self.report(path, found.start(), seen, f"{found.group()!r} is {what}")

    def given(self, path, memo):
        """The standard headers that a file and those of ours that it includes name."""
        if path not in memo:
            memo[path] = set()
            for opening, name in re.findall(r'^\s*#\s*include\s*([<"])([^">]+)[">]', self.code[path], re.M):
                if opening == "<":
                    memo[path].add(name)
                    if name.startswith("nanobind/stl/"):
                        memo[path].add(name[len("nanobind/stl/"):-len(".h")])
                    continue
                for folder in FOLDERS.values():
                    if folder / name in self.code:
                        memo[path] |= self.given(folder / name, memo)
        return memo[path]

    def test_each_header_of_the_standard_library_that_is_used_is_included(self):
        """In the file or in one of ours that it includes: what a library's own headers bring differs."""
        memo, missing = {}, []
        for path, code in self.code.items():
            given = self.given(path, memo)
            for header, used in USED.items():
                found = used.search(code)
                if found and header not in given:
                    line = code.count("\n", 0, found.start()) + 1
                    missing.append(f"{path.relative_to(SOURCE)}:{line}: {found.group()} needs <{header}>")
        self.assertEqual(missing, [])

    def test_texts_are_no_longer_than_every_compiler_takes(self):
        """MSVC takes literals of 16380 bytes, and texts of 65535 that stand in several literals."""
        for path, text in self.read.items():
            for at, size in texts_of(text):
                if size > 16000:
                    self.report(path, at, text, f"a text of {size} bytes; allowed: at most 16000")


class Readers(unittest.TestCase):
    def test_comments_and_texts_are_no_code(self):
        code = 'int a; // fork()\nauto b = "not \\" and"; /* M_PI\n */ char c = \'"\'; int d;\n#include "x/y.h"'
        self.assertEqual(without_texts(code),
                         'int a; \nauto b = ""; \n char c = \'\'; int d;\n#include "x/y.h"')

    def test_sections_for_one_compiler_are_left_out(self):
        code = ("a\n#if defined(__GNUC__)\nb\n#if X\nc\n#endif\n#elif __clang__\nd\n#else\ne\n#endif\n"
                "#if X\nf\n#elif _WIN32\ng\n#endif\nh")
        self.assertEqual([line for line in for_every_compiler(code).split() if len(line) == 1 and line != "X"],
                         ["a", "e", "f", "h"])

    def test_texts_beside_each_other_are_one(self):
        self.assertEqual([size for _, size in texts_of('f("ab"\n  "cde", "f");')], [5, 1])


if __name__ == "__main__":
    unittest.main(verbosity=2)
