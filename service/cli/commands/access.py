"""Commands on who may do what: logins, users, tokens."""

from pathlib import Path
from typing import Annotated

import typer

from service.cli.commands.options import DEFAULT_URL, Csv, Json, Url
from service.roles import Role

commands = typer.Typer()

Name = Annotated[str, typer.Argument(metavar="NAME", help="The user's name.")]
Roles = Annotated[list[Role] | None, typer.Option("--role", help="A role; give several for more.")]
Sites = Annotated[
    list[str] | None,
    typer.Option("--site", metavar="SITE", help="A site where the roles hold (default: all); repeatable."),
]
FullName = Annotated[str | None, typer.Option(metavar="TEXT", help="What people call them.")]
PasswordFile = Annotated[
    str | None,
    typer.Option(metavar="FILE", help="Its first line is the password; - for the standard input."),
]
CodeFile = Annotated[
    str | None,
    typer.Option(
        metavar="FILE", help="Its first line is the code of the second factor; - for the standard input."
    ),
]
Config = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Work in the database of this settings file, as its owner may."),
]
Local = Annotated[
    bool, typer.Option("--local", help="The same, with the settings of the environment (MCC_...).")
]


@commands.command()
def login(
    url: Url = DEFAULT_URL,
    name: Annotated[
        str | None, typer.Option(metavar="NAME", help="Who logs in (default: as on this machine).")
    ] = None,
    password_file: PasswordFile = None,
    code_file: CodeFile = None,
    *,
    as_json: Json = False,
) -> None:
    """Log in at a service; the commands that follow say who asks, until mcc logout or the session's end."""
    from service.cli.access.login import log_in

    log_in(url, name, password_file=password_file, code_file=code_file, as_json=as_json)


@commands.command()
def logout(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """End the session at a service."""
    from service.cli.access.login import log_out

    log_out(url, as_json=as_json)


@commands.command()
def whoami(url: Url = DEFAULT_URL, *, as_json: Json = False) -> None:
    """Show who the service takes you for, and what you may do there."""
    from service.cli.access.login import show_account

    show_account(url, as_json=as_json)


@commands.command()
def password(
    url: Url = DEFAULT_URL,
    old_file: Annotated[
        str | None, typer.Option(metavar="FILE", help="Its first line is the present password.")
    ] = None,
    new_file: Annotated[
        str | None, typer.Option(metavar="FILE", help="Its first line is the new password.")
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Change your own password; all your sessions and tokens end."""
    from service.cli.access.login import change_password

    change_password(url, old_file=old_file, new_file=new_file, as_json=as_json)


factor = typer.Typer(
    help="Your second factor: an authenticator app, and recovery codes.", no_args_is_help=True
)
commands.add_typer(factor, name="second-factor")


@factor.command("set-up")
def set_up_second_factor(
    url: Url = DEFAULT_URL,
    password_file: PasswordFile = None,
    code_file: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Its first line is a code of the app; - for the standard input."),
    ] = None,
    *,
    as_json: Json = False,
) -> None:
    """Set up an authenticator app, and print recovery codes; log in before (mcc login)."""
    from service.cli.access.second_factor import set_up

    set_up(url, password_file=password_file, code_file=code_file, as_json=as_json)


@factor.command("codes")
def make_recovery_codes(
    url: Url = DEFAULT_URL, password_file: PasswordFile = None, *, as_json: Json = False
) -> None:
    """Print other recovery codes; the old ones count no more."""
    from service.cli.access.second_factor import make_codes

    make_codes(url, password_file=password_file, as_json=as_json)


@factor.command("remove")
def remove_second_factor(
    url: Url = DEFAULT_URL, password_file: PasswordFile = None, *, as_json: Json = False
) -> None:
    """Remove your second factor, where no role of yours needs one."""
    from service.cli.access.second_factor import remove

    remove(url, password_file=password_file, as_json=as_json)


user = typer.Typer(help="Make, change and delete users.", no_args_is_help=True)
commands.add_typer(user, name="user")


@user.command("list")
def list_users(
    url: Url = DEFAULT_URL,
    config: Config = None,
    *,
    local: Local = False,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show the users, their roles and last logins."""
    from service.cli.access.users import list_users

    list_users(url, config, local=local, as_csv=as_csv, as_json=as_json)


@user.command("add")
def add_user(
    name: Name,
    role: Roles = None,
    site: Sites = None,
    url: Url = DEFAULT_URL,
    config: Config = None,
    full_name: FullName = None,
    password_file: PasswordFile = None,
    *,
    no_password: Annotated[
        bool, typer.Option("--no-password", help="Nobody logs in as them: for tokens, or a proxy's users.")
    ] = False,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """Make a user; the password is asked for, and they change it first.

    The first user, and those with the role SECAUD, are made with --config FILE.
    """
    from service.cli.access.users import add_user

    add_user(
        url,
        config,
        name,
        role or [],
        sites=site or None,
        full_name=full_name,
        password_file=password_file,
        no_password=no_password,
        local=local,
        as_json=as_json,
    )


@user.command("change")
def change_user(
    name: Name,
    role: Roles = None,
    site: Sites = None,
    url: Url = DEFAULT_URL,
    config: Config = None,
    full_name: FullName = None,
    *,
    all_sites: Annotated[bool, typer.Option("--all-sites", help="Their roles hold at all sites.")] = False,
    no_roles: Annotated[bool, typer.Option("--no-roles", help="Take all roles away.")] = False,
    disabled: Annotated[
        bool | None, typer.Option("--disable/--enable", help="Keep them out, or let them in again.")
    ] = None,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """Give a user other roles, sites or another name, or keep them out; other roles end their sessions.

    The role SECAUD is given with --config FILE, and the user then needs a new password.
    """
    from service.cli.access.users import change_user

    change_user(
        url,
        config,
        name,
        roles=role,
        no_roles=no_roles,
        sites=site,
        all_sites=all_sites,
        full_name=full_name,
        disabled=disabled,
        local=local,
        as_json=as_json,
    )


@user.command("password")
def set_password(
    name: Name,
    url: Url = DEFAULT_URL,
    config: Config = None,
    password_file: PasswordFile = None,
    *,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """Change a user's password, which ends their sessions and tokens; they change it first."""
    from service.cli.access.users import set_password

    set_password(url, config, name, password_file=password_file, local=local, as_json=as_json)


@user.command("unlock")
def unlock_user(
    name: Name, url: Url = DEFAULT_URL, config: Config = None, *, local: Local = False, as_json: Json = False
) -> None:
    """Let a user log in again at once after too many logins that failed."""
    from service.cli.access.users import unlock_user

    unlock_user(url, config, name, local=local, as_json=as_json)


@user.command("logout")
def end_sessions(
    name: Name, url: Url = DEFAULT_URL, config: Config = None, *, local: Local = False, as_json: Json = False
) -> None:
    """End all sessions and tokens of a user."""
    from service.cli.access.users import end_sessions

    end_sessions(url, config, name, local=local, as_json=as_json)


@user.command("reset-second-factor")
def reset_second_factor(
    name: Name, url: Url = DEFAULT_URL, config: Config = None, *, local: Local = False, as_json: Json = False
) -> None:
    """Remove a user's second factor, and print a code that stands for it at one login."""
    from service.cli.access.users import reset_second_factor

    reset_second_factor(url, config, name, local=local, as_json=as_json)


@user.command("delete")
def delete_user(
    name: Name, url: Url = DEFAULT_URL, config: Config = None, *, local: Local = False, as_json: Json = False
) -> None:
    """Delete a user with their sessions and tokens; what they did stays in the audit trail."""
    from service.cli.access.users import delete_user

    delete_user(url, config, name, local=local, as_json=as_json)


token = typer.Typer(help="Make and revoke tokens, the secrets of programs.", no_args_is_help=True)
commands.add_typer(token, name="token")


@token.command("list")
def list_tokens(
    url: Url = DEFAULT_URL,
    config: Config = None,
    *,
    local: Local = False,
    as_csv: Csv = False,
    as_json: Json = False,
) -> None:
    """Show your tokens, or those of all users if you manage them; never their secrets."""
    from service.cli.access.tokens import list_tokens

    list_tokens(url, config, local=local, as_csv=as_csv, as_json=as_json)


@token.command("add")
def add_token(
    label: Annotated[str, typer.Argument(metavar="LABEL", help="What it is for.")],
    url: Url = DEFAULT_URL,
    config: Config = None,
    user: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="A user whom nobody can log in as, with --config or --local."),
    ] = None,
    scope: Annotated[
        list[str] | None,
        typer.Option(metavar="PERMISSION", help="A permission it has (default: all that you have)."),
    ] = None,
    site: Annotated[
        list[str] | None,
        typer.Option("--site", metavar="SITE", help="A site where it holds (default: all of yours)."),
    ] = None,
    days: Annotated[
        float | None,
        typer.Option(min=0.001, max=36_500, help="So long it is taken (default: as long as it may)."),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the secret into this file, for its owner's eyes only."),
    ] = None,
    *,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """Make a token; its secret is printed this once."""
    from service.access.permissions import Permission
    from service.cli.access.tokens import add_token

    known = [permission.value for permission in Permission]
    for word in scope or ():
        if word not in known:
            raise typer.BadParameter(f"--scope: expected one of {', '.join(known)}, found {word!r}")
    add_token(
        url,
        config,
        label,
        user=user,
        scope=scope or None,
        sites=site or None,
        days=days,
        output=output,
        local=local,
        as_json=as_json,
    )


@token.command("revoke")
def revoke_token(
    token_id: Annotated[
        str, typer.Argument(metavar="ID", help="The token's id, as mcc token list shows it.")
    ],
    url: Url = DEFAULT_URL,
    config: Config = None,
    *,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """End a token, and those that were made with it."""
    from service.cli.access.tokens import revoke_token

    revoke_token(url, config, token_id, local=local, as_json=as_json)


@token.command("revoke-all")
def revoke_tokens(
    url: Url = DEFAULT_URL,
    config: Config = None,
    user: Annotated[
        str | None, typer.Option(metavar="NAME", help="Whose tokens end (default: yours).")
    ] = None,
    *,
    local: Local = False,
    as_json: Json = False,
) -> None:
    """End all tokens of a user."""
    from service.cli.access.tokens import revoke_tokens

    revoke_tokens(url, config, user=user, local=local, as_json=as_json)
