// JSON parser: text into a document, strictly.
#include "scene/files/json.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace throng {
namespace {

void append_utf8(std::string& out, unsigned code)
{
    const auto add = [&](unsigned byte) { out += static_cast<char>(byte); };
    if (code < 0x80) return add(code);
    if (code < 0x800) {
        add(0xc0 | code >> 6);
    } else {
        if (code < 0x10000) {
            add(0xe0 | code >> 12);
        } else {
            add(0xf0 | code >> 18);
            add(0x80 | (code >> 12 & 0x3f));
        }
        add(0x80 | (code >> 6 & 0x3f));
    }
    add(0x80 | (code & 0x3f));
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

/// Fills the nodes of one document.
class JsonParser {
public:
    explicit JsonParser(JsonDocument& document)
        : document_(document), text_(document.text_), nodes_(document.nodes_)
    { }

    void parse()
    {
        if (text_.size() >= std::numeric_limits<std::uint32_t>::max())
            fail(0, "wanted a text of less than 4 GiB; bulk files hold more");
        // Two numbers or one member with its punctuation make about this many bytes a node.
        nodes_.reserve(text_.size() / 8 + 16);
        if (text_.starts_with("\xef\xbb\xbf")) fail(0, "wanted no byte order mark");
        skip_space();
        parse_value(0);
        skip_space();
        if (at_ != text_.size()) fail(at_, "wanted nothing after the end, not " + shown());
    }

private:
    using Node = JsonDocument::Node;

    char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

    void skip_space()
    {
        while (at_ < text_.size()
               && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r'
                   || text_[at_] == '\t'))
            ++at_;
    }

    /// What stands here, for a message.
    std::string shown() const
    {
        if (at_ >= text_.size()) return "the end of the file";
        std::size_t end = at_;
        const auto in_word = [](char c) {
            return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.'
                || c == '-' || c == '+' || c == '_';
        };
        while (end < text_.size() && in_word(text_[end])) ++end;
        if (end > at_) return in_quotes(text_.substr(at_, end - at_));
        const std::size_t length = utf8_length(text_.substr(at_, 4));
        return length == 0 ? "a byte that is no UTF-8" : in_quotes(text_.substr(at_, length));
    }

    [[noreturn]] void fail(std::size_t at, const std::string& wanted) const
    {
        throw scene_error(document_.file_, text_, at, path_text(open_), wanted);
    }

    Node add(JsonKind kind)
    {
        nodes_.push_back({0, static_cast<std::uint32_t>(at_), 0, 0, kind, false});
        return static_cast<Node>(nodes_.size() - 1);
    }
    void close(Node node) { nodes_[node].next = static_cast<std::uint32_t>(nodes_.size()); }

    void parse_value(int depth)
    {
        switch (peek()) {
        case '{':
        case '[':
            if (depth == JsonDocument::kDeepest)
                fail(at_, "wanted at most " + std::to_string(depth) + " levels of nesting");
            return peek() == '{' ? parse_object(depth) : parse_array(depth);
        case '"':
            return parse_string();
        case 't':
            return parse_word("true", JsonKind::boolean, 1);
        case 'f':
            return parse_word("false", JsonKind::boolean, 0);
        case 'n':
            return parse_word("null", JsonKind::null, 0);
        default:
            return parse_number();
        }
    }

    void parse_word(std::string_view word, JsonKind kind, double value)
    {
        const std::string here = shown();
        if (here != '"' + std::string(word) + '"') fail(at_, "wanted a value, not " + here);
        const Node node = add(kind);
        nodes_[node].number = value;
        at_ += word.size();
        close(node);
    }

    void parse_number()
    {
        const std::size_t start = at_;
        if (peek() != '-' && !is_digit(peek())) fail(at_, "wanted a value, not " + shown());
        if (peek() == '-') ++at_;
        if (peek() == '0' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1]))
            fail(start, "wanted a number without leading zeros");
        skip_digits(start);
        if (peek() == '.') {
            ++at_;
            skip_digits(start);
        }
        if (peek() == 'e' || peek() == 'E') {
            ++at_;
            if (peek() == '+' || peek() == '-') ++at_;
            skip_digits(start);
        }
        const std::string_view digits = text_.substr(start, at_ - start);
        const double value = to_double(digits);
        if (!std::isfinite(value))
            fail(start, "wanted a number that a double can hold, not " + in_quotes(digits));
        nodes_.push_back({value, static_cast<std::uint32_t>(start),
                          static_cast<std::uint32_t>(digits.size()),
                          static_cast<std::uint32_t>(nodes_.size() + 1), JsonKind::number, false});
    }

    void skip_digits(std::size_t start)
    {
        const std::size_t first = at_;
        while (is_digit(peek())) ++at_;
        if (at_ != first) return;
        at_ = start;
        fail(start, "wanted a number, not " + shown());
    }

    /// Infinite when beyond double; what is smaller than a double can hold rounds to zero.
    static double to_double(std::string_view digits)
    {
        double value = 0;
        const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (result.ec == std::errc{}) return value;

        // Out of range one way or the other: the power of ten of the first digit tells.
        const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
        const std::string_view mantissa = digits.substr(0, e);
        const std::size_t first = mantissa.find_first_of("123456789");
        if (first == mantissa.npos) return 0;
        const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
        const bool tiny_power = e + 1 < digits.size() && digits[e + 1] == '-';
        const bool signed_power = tiny_power || (e + 1 < digits.size() && digits[e + 1] == '+');
        const std::string_view power =
            digits.substr(std::min(e + (signed_power ? 2 : 1), digits.size()));
        // Far beyond any number of digits in a file, and small enough to add them to.
        constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 2;
        std::int64_t exponent = 0;
        const auto read = std::from_chars(power.data(), power.data() + power.size(), exponent);
        if (read.ec == std::errc::result_out_of_range || exponent > kMost) exponent = kMost;
        const std::int64_t before_point =
            static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
        const bool tiny = before_point + (tiny_power ? -exponent : exponent) <= 0;
        if (!tiny) return std::numeric_limits<double>::infinity();
        return digits[0] == '-' ? -0.0 : 0.0;
    }

    void parse_string()
    {
        const Node node = add(JsonKind::string);
        const std::size_t start = ++at_;
        std::optional<std::string> unescaped;  // made at the first escape
        for (;;) {
            const std::size_t run = at_;
            skip_plain();
            if (unescaped) unescaped->append(text_.substr(run, at_ - run));
            if (at_ >= text_.size()) fail(start - 1, "wanted a closing quote for this text");
            if (text_[at_] == '"') break;
            if (text_[at_] != '\\')
                fail(at_, "wanted text without control characters; write \\u00XX");
            if (!unescaped) unescaped.emplace(text_.substr(start, at_ - start));
            parse_escape(*unescaped);
        }
        nodes_[node].size = static_cast<std::uint32_t>(at_ - start);
        if (unescaped) {
            nodes_[node].escaped = true;
            nodes_[node].number = static_cast<double>(document_.unescaped_.size());
            document_.unescaped_.push_back(std::move(*unescaped));
        }
        ++at_;
        close(node);
    }

    /// Up to a quote, a backslash, a control character or the end.
    void skip_plain()
    {
        while (at_ < text_.size()) {
            const auto byte = static_cast<unsigned char>(text_[at_]);
            if (byte < 0x20 || byte == '"' || byte == '\\') return;
            const std::size_t length = byte < 0x80 ? 1 : utf8_length(text_.substr(at_, 4));
            if (length == 0) fail(at_, "wanted text in UTF-8");
            at_ += length;
        }
    }

    void parse_escape(std::string& out)
    {
        constexpr std::string_view kLetters = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
        const std::size_t start = at_++;
        const std::size_t known = at_ < text_.size() ? kLetters.find(text_[at_]) : kLetters.npos;
        if (known != kLetters.npos) {
            out += kMeanings[known];
            ++at_;
            return;
        }
        if (peek() != 'u')
            fail(start, R"(wanted one of the escapes \" \\ \/ \b \f \n \r \t \uXXXX)");
        unsigned code = parse_hex(start);
        if (code >= 0xdc00 && code < 0xe000) fail(start, kLoneSurrogate);
        if (code >= 0xd800 && code < 0xdc00) {
            if (text_.substr(at_, 2) != "\\u") fail(start, kLoneSurrogate);
            ++at_;
            const unsigned low = parse_hex(start);
            if (low < 0xdc00 || low >= 0xe000) fail(start, kLoneSurrogate);
            code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
        }
        append_utf8(out, code);
    }

    /// The four digits after the u.
    unsigned parse_hex(std::size_t start)
    {
        unsigned code = 0;
        const std::string_view digits = text_.substr(at_ + 1, 4);
        const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (digits.size() != 4 || result.ptr != digits.data() + 4)
            fail(start, "wanted four hexadecimal digits after \\u");
        at_ += 5;
        return code;
    }

    void parse_array(int depth)
    {
        const Node node = add(JsonKind::array);
        ++at_;
        skip_space();
        std::uint32_t count = 0;
        open_.emplace_back(std::size_t{0});
        for (; peek() != ']' || count > 0; ++count) {
            open_.back().index = count;
            parse_value(depth + 1);
            if (!more(']')) {
                ++count;
                break;
            }
        }
        open_.pop_back();
        ++at_;
        nodes_[node].size = count;
        close(node);
    }

    /// Past a comma: true. At the closing bracket: false.
    bool more(char closing)
    {
        skip_space();
        if (peek() == closing) return false;
        if (peek() != ',') fail(at_, "wanted , or " + std::string(1, closing) + ", not " + shown());
        ++at_;
        skip_space();
        if (peek() == closing) fail(at_, std::string("wanted no comma before ") + closing);
        return true;
    }

    void parse_object(int depth)
    {
        const Node node = add(JsonKind::object);
        ++at_;
        skip_space();
        std::uint32_t count = 0;
        for (bool wanted = peek() != '}'; wanted; wanted = more('}')) {
            if (peek() != '"') fail(at_, "wanted a key in quotes, not " + shown());
            const auto key = static_cast<Node>(nodes_.size());
            parse_string();
            open_.emplace_back(std::string(document_.text(key)));
            skip_space();
            if (peek() != ':') fail(at_, "wanted : after the key, not " + shown());
            ++at_;
            skip_space();
            parse_value(depth + 1);
            open_.pop_back();
            ++count;
        }
        ++at_;
        nodes_[node].size = count;
        close(node);
        refuse_duplicates(node);
    }

    void refuse_duplicates(Node object)
    {
        const std::size_t first_key = keys_.size();
        for (Node at = object + 1; at != nodes_[object].next; at = nodes_[at + 1].next)
            keys_.push_back({document_.text(at), at});
        std::sort(keys_.begin() + static_cast<std::ptrdiff_t>(first_key), keys_.end());
        Node second = 0;
        for (std::size_t i = first_key; i + 1 < keys_.size(); ++i)
            if (keys_[i].name == keys_[i + 1].name && (second == 0 || keys_[i + 1].node < second))
                second = keys_[i + 1].node;
        keys_.resize(first_key);
        if (second == 0) return;
        const std::string_view name = document_.text(second);
        open_.emplace_back(std::string(name));
        fail(nodes_[second].at, "wanted each key once, not " + in_quotes(name) + " again");
    }

    static constexpr const char* kLoneSurrogate = "wanted a pair of surrogates, not a lone one";

    struct Key {
        std::string_view name;
        Node node;
        auto operator<=>(const Key&) const = default;  // NOLINT(modernize-use-nullptr): has none
    };

    JsonDocument& document_;
    std::string_view text_;
    std::vector<JsonDocument::Item>& nodes_;
    std::vector<Key> keys_;  // of the object being closed
    ScenePath open_;         // where the parser is
    std::size_t at_ = 0;
};

JsonDocument::JsonDocument(std::string text, std::string file)
    : text_(std::move(text)), file_(std::move(file))
{
    JsonParser(*this).parse();
}

}  // namespace throng
