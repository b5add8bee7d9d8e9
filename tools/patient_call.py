"""Call a program that ends by itself after Ctrl-C, when it has written its checkpoint."""
import subprocess


def call(command, **options):
    """Exit code. Ctrl-C reaches the program as well; it goes on here when that has ended, instead of killing it."""
    process = subprocess.Popen(command, **options)
    try:
        return process.wait()
    except KeyboardInterrupt:
        process.wait()
        raise
