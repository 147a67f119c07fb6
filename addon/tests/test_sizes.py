"""Numbers of bytes and shares as people read them."""

from velour.core.sizes import data_size, limit_size, percent


def test_files_have_decimal_units_and_three_digits():
    sizes = (0, 999, 2345, 99_949, 99_950, 380_000, 999_499, 999_500, 12_345_678, 1.5e9, 2e15)
    assert [data_size(size) for size in sizes] == [
        "0 bytes",
        "999 bytes",
        "2.35 kB",
        "99.9 kB",
        "100 kB",
        "380 kB",
        "999 kB",
        "1.00 MB",
        "12.3 MB",
        "1.50 GB",
        "2,000 TB",
    ]


def test_limits_of_memory_have_binary_ones():
    assert [limit_size(size) for size in (1023, 1 << 20, 1536 << 20)] == ["1023 bytes", "1 MiB", "1.5 GiB"]


def test_shares_have_no_exponent():
    shares = (0, 1e-7, 0.0001, 0.0086, 0.5, 0.994, 0.996, 1.0, 12.345)
    assert [percent(share) for share in shares] == [
        "0 %",
        "0 %",
        "0.01 %",
        "0.86 %",
        "50 %",
        "99 %",
        "100 %",
        "100 %",
        "1234 %",
    ]
